#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "bake/physics/path_integral/grid_medium.h"
#include "bake/physics/phase_series.h"

namespace opaline::bake {

/// A phase function as a peak that does not turn light, and a smooth rest [Wiscombe1977]:
/// p = share delta + (1 - share) rest.
struct ForwardSplit {
    double share = 0;  ///< in [0, 1)
    PhaseSeries rest;  ///< degrees 0 to N, tail 0; may be negative somewhere
};

/// The split at degree N: share = lambda_(N+1), rest lambda'_l = (lambda_l - share) / (1 - share).
/// All moments up to N of light that is scattered any number of times are those of the whole phase
/// function. lambda_(N+1) <= 0 is no peak: the share is 0. Precondition: N + 2 degrees or more, and
/// lambda_(N+1) < 1.
ForwardSplit split_forward_peak(const PhaseSeries& series, unsigned degree);

/// What the rest does to light, the peak counted as not scattered: b' = b (1 - share),
/// c' = c - share b. The absorption stays. `share` in [0, 1).
inline Coefficients without_peak(Coefficients medium, double share) {
    return {medium.scattering * (1 - share), medium.absorption};
}

/// A turn in the plane of two directions: the direction at angle phi in [0, angle] is
/// cos(phi) from + sin(phi) aside. It replaces the rotation of [Premoze2003] (9) and (10).
struct Turn {
    glm::dvec3 from{0, 0, 1};  ///< unit
    glm::dvec3 aside{0};       ///< unit, perpendicular to `from`; 0 if `from` and `to` are equal
    glm::dvec3 to{0, 0, 1};    ///< unit
    double angle = 0;          ///< [rad], in [0, pi]
};

/// The shortest turns between two directions: one, or four if the directions are opposite.
class Turns {
  public:
    /// `from` and `to`: unit vectors. Opposite directions span no plane: the four turns lie at
    /// right angles around `from`, and the mean over them stands for that over all planes.
    Turns(glm::dvec3 from, glm::dvec3 to);

    std::size_t size() const { return count_; }
    const Turn& operator[](std::size_t i) const { return turn_[i]; }
    const Turn* begin() const { return turn_.data(); }
    const Turn* end() const { return turn_.data() + count_; }

  private:
    std::array<Turn, 4> turn_;
    std::size_t count_ = 1;
};

}  // namespace opaline::bake
