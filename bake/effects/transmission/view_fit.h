#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::bake {

/// Views of a receiver, those of uniform light in reverse: of density F_t(c) c over the outer
/// hemisphere, c the cosine with the normal.
struct TransmissionViews {
    std::vector<glm::vec3> seen;  ///< unit, refracted: inside, toward the eye
    std::vector<double> weight;   ///< sum 1
};

/// `count` of them, evenly spread: a spiral with equal steps in c^2. `shift`: in [0, 1)^2, of the
/// steps and of the azimuth. Where nothing enters, as below the critical angle, are fewer. Empty:
/// nothing enters at all.
TransmissionViews spread_views(glm::vec3 normal, double eta, std::uint32_t count, glm::vec2 shift);

/// Gives the weight of some views to the others; of all of them, to none.
void leave_out(TransmissionViews& views, std::span<const std::uint32_t> some);

/// How a function of the view inside, known at a set of views, becomes harmonics: the row k is the
/// sum over views i of factor[i * terms + k] times its value there (README.md, "Views").
/// `terms` 1: their mean; 4, 9 …: weighted least squares, smoothed.
std::vector<float> fit_views(const TransmissionViews& views, std::uint32_t terms);

/// Scales the rows by view until under even light no view of the set is darker than the darkest, as
/// a fit of the lowest degrees to light that falls fast with the cosine would be. `even`: what each
/// view shows of even light, >= 0. `terms` > 1.
void limit_fit(const TransmissionViews& views, std::uint32_t terms, std::span<const double> even,
               std::span<float> factors);

/// Keeps what rows by view show of light from one direction >= 0 in every view (README.md,
/// "Views"). Immutable once made.
class NonNegativeViews {
  public:
    /// `terms` > 1.
    NonNegativeViews(const TransmissionViews& views, glm::vec3 normal, double eta,
                     std::uint32_t terms);
    /// Scales rows k at first[k * stride], around their mean over the views, >= 0. Returns it.
    double apply(float* first, std::size_t stride) const;

  private:
    std::vector<double> mean_;   // of each harmonic over the views
    std::vector<double> probe_;  // harmonics of views up to the rim, view by view
};

/// That fit, over all views there are, seen along `seen`: the mean over views w' of k(w') times
/// the function. Immutable once made.
class ViewKernel {
  public:
    ViewKernel(glm::vec3 normal, double eta, std::uint32_t terms, glm::vec3 seen);
    double operator()(glm::vec3 view) const;

  private:
    std::vector<double> mean_, slope_;
};

}  // namespace opaline::bake
