#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/walk.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/sparse_vectors.h"

namespace opaline::bake {

/// The light at a walk's exit as a row: E_j of the sample nearby, times a linear function of the
/// light's direction w that remembers the walk's own direction w_e, or its mean (README.md, "The
/// light at an exit"),
///     E_j(w) / (pi c_exit) (a_0 + a . w).
/// Its mean over exits that are distributed as diffuse light from inside is E_j / (pi c_exit), and
/// it is exact for unoccluded light that is linear in w.
struct ExitLobe {
    double mean = 0;      ///< of the cosine c under p = F_t c / (pi c_exit)
    double variance = 1;  ///< of c
    double across = 1;    ///< mean square of each coordinate across the normal
    double diffuse = 0;   ///< mean of c over exits of light that was scattered often
    double eta = 1;       ///< of the boundary

    /// a_0, a_x, a_y, a_z; `normal` of the sample, `exit` away from the body, both unit.
    glm::vec4 eval(glm::vec3 normal, glm::vec3 exit) const;
    /// Their mean over exits of light that was scattered often, of walks with the same way and
    /// length (WalkExit::drift): the same, with much less noise.
    glm::vec4 eval_diffuse(glm::vec3 normal, glm::vec3 drift) const;
};

/// `eta` > 0.
ExitLobe make_exit_lobe(double eta);

/// z, in transport mean free paths: inside a boundary of that index light that was scattered often
/// has a radiance of z + c' in proportion, c' the cosine toward the boundary.
double extrapolation_length(double eta);

/// Surface samples and the light that enters through them, ready for exits.
class ExitLight {
  public:
    /// `light`: Haar vectors of A_j E_j; `moments`: of A_j E_j w, axis by axis, or null for exits
    /// that forget their direction. `escape`: c_exit. `other`: A_j E_j of light that is diffuse
    /// (SampleTransport::other), or null. All must outlive this.
    ExitLight(std::span<const SurfaceSample> samples, const SparseVectors& light,
              const std::array<SparseVectors, 3>* moments, double eta, double escape,
              const SparseVectors* other = nullptr);

    /// The nearest sample that faces as the exit does; where there is none, the nearest.
    /// Precondition: there are samples.
    std::uint32_t nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const;

    /// Factors of the sample's four vectors for an exit of weight 1.
    glm::vec4 factors(std::uint32_t sample, const WalkExit& exit) const;

    /// Adds weight[b] * (factors . vectors) of a sample to a row of four floats per texel.
    void add(std::uint32_t sample, const std::array<glm::vec4, 3>& factors,
             std::span<float> rgbx) const;
    /// The first of the four vectors alone, to as many rows one after the other as are asked for,
    /// with weight[row][b].
    void add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                   std::span<float> rows) const;

  private:
    void add_other(std::uint32_t sample, const std::array<float, 3>& weight,
                   std::span<float> rgbx) const;

    std::span<const SurfaceSample> samples_;
    const SparseVectors& light_;
    const std::array<SparseVectors, 3>* moments_;
    const SparseVectors* other_;
    ExitLobe lobe_;
    float scale_;  // 1 / (pi c_exit)
    PointGrid grid_;
};

}  // namespace opaline::bake
