#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "bake/physics/path_integral/grid_medium.h"
#include "bake/physics/path_integral/turn.h"

namespace opaline::bake {

/// The most probable path between two directions in a medium of constant albedo, for a given
/// scattering depth ell = int b ds: it turns uniformly in ell, then it is straight [Premoze2003]
/// (9) to (11).
struct QuasiPath {
    glm::dvec3 start{0};   ///< [m]
    Turn turn;             ///< from the first direction to the last
    double ell_total = 1;  ///< scattering depth at which the turn is complete, >= kShortestTurn
};

/// Smallest scattering depth of a turn. A path that starts where it leaves the medium has none to
/// turn in: it turns at once. Far below the depth of any medium, so that thin ones are similar.
inline constexpr double kShortestTurn = 1e-30;

/// Where a march ends, and its longest step.
struct MarchLimits {
    VolumeBox box;    ///< holds the start
    double step = 1;  ///< [m], > 0: the edge of a voxel. The error falls with its square
    double length = std::numeric_limits<double>::infinity();  ///< of the path [m], > 0
};

/// One step of a march, at its middle.
struct PathStep {
    glm::dvec3 position{0};  ///< [m]
    double ell = 0;          ///< scattering depth of the path up to here
    double absorption = 0;   ///< absorption depth A = int a ds of the path up to here
    double depth = 0;        ///< scattering depth b ds of the step
    double length = 0;       ///< ds [m]
};

/// The end of a march.
struct PathEnd {
    glm::dvec3 position{0};   ///< [m]
    glm::dvec3 direction{0};  ///< unit
    double ell = 0, absorption = 0;
    double length = 0;  ///< of the path [m]
};

/// The direction of a path, turned by small amounts without trigonometric functions.
class Heading {
  public:
    /// Refers to the path, which must stay.
    explicit Heading(const QuasiPath& path)
        : turn_(path.turn),
          ell_total_(path.ell_total),
          rate_(path.turn.angle / path.ell_total),
          middle_(path.turn.from),
          direction_(path.turn.from) {}

    const glm::dvec3& direction() const { return direction_; }
    /// The direction in the middle of the last step.
    const glm::dvec3& middle() const { return middle_; }

    /// Turns over a step from the scattering depth `ell`, where the last one ended, to `ell` +
    /// `depth`.
    void advance(double ell, double depth) {
        const double angle = rate_ * ell, half = 0.5 * rate_ * depth;
        if (ell + depth >= ell_total_) {
            middle_ = ell + 0.5 * depth >= ell_total_ ? turn_.to : at_angle(angle + half);
            direction_ = turn_.to;
        } else if (half < kSmall) {
            const double d = half * half;
            const double s = half * (1 - d * (1. / 6 - d * (1. / 120 - d * (1. / 5040))));
            const double c = 1 - d * (1. / 2 - d * (1. / 24 - d * (1. / 720 - d * (1. / 40320))));
            rotate(c, s);
            middle_ = cosine_ * turn_.from + sine_ * turn_.aside;
            rotate(c, s);
            direction_ = cosine_ * turn_.from + sine_ * turn_.aside;
        } else {
            middle_ = at_angle(angle + half);
            cosine_ = std::cos(angle + 2 * half);
            sine_ = std::sin(angle + 2 * half);
            direction_ = cosine_ * turn_.from + sine_ * turn_.aside;
        }
    }

  private:
    static constexpr double kSmall = 0.1;  ///< [rad]; the series are exact to 3e-15

    glm::dvec3 at_angle(double angle) const {
        return std::cos(angle) * turn_.from + std::sin(angle) * turn_.aside;
    }
    void rotate(double c, double s) {
        const double turned = cosine_ * c - sine_ * s;
        sine_ = sine_ * c + cosine_ * s;
        cosine_ = turned;
    }

    const Turn& turn_;
    double ell_total_, rate_;
    double cosine_ = 1, sine_ = 0;  ///< of the angle turned so far
    glm::dvec3 middle_, direction_;
};

/// Marches along a path and calls `bool visit(const PathStep&)` in the middle of every step; the
/// march ends after the step for which that is false, where the path leaves the box, or at the
/// longest length. The rule is the midpoint rule in arc length, of second order: integrals are sums
/// of f(step) step.length. Steps are so short that b ds <= max(1, ell) / 4, or twice that where the
/// medium becomes denser, and finite in empty space, unlike steps in ell. The march ends for every
/// finite medium: a path that turns by at most pi is no longer in its box than pi times the box's
/// diagonal.
template <class Medium, class Visit>
PathEnd march_quasi_path(const QuasiPath& path, const Medium& medium, const MarchLimits& limits,
                         Visit&& visit) {
    Heading heading(path);
    PathEnd at{path.start, path.turn.from};
    double scattering = Coefficients(medium(path.start)).scattering;
    bool on = true;
    while (on && at.length < limits.length && limits.box.contains(at.position)) {
        const double deepest = 0.25 * std::max(1.0, at.ell);
        double ds = std::min(limits.step, limits.length - at.length);
        if (scattering * ds > deepest) {
            ds = deepest / scattering;
        }
        const glm::dvec3 direction = heading.direction();
        if (!limits.box.contains(at.position + ds * direction)) {
            ds = std::min(ds, exit_distance(limits.box, at.position, direction));
            if (ds <= 1e-12 * limits.step) break;
        }
        glm::dvec3 middle = at.position + 0.5 * ds * direction;
        Coefficients here = medium(middle);
        while (here.scattering * ds > 2 * deepest) {
            ds = deepest / here.scattering;
            middle = at.position + 0.5 * ds * direction;
            here = medium(middle);
        }
        scattering = here.scattering;

        const double depth = scattering * ds, absorption = here.absorption * ds;
        on = visit(
            PathStep{middle, at.ell + 0.5 * depth, at.absorption + 0.5 * absorption, depth, ds});
        heading.advance(at.ell, depth);
        at.position += ds * heading.middle();
        at.ell += depth;
        at.absorption += absorption;
        at.length += ds;
    }
    at.direction = heading.direction();
    return at;
}

/// Depth int f ds along a ray from `x` in a finite box to where the ray leaves it, by the midpoint
/// rule in equal steps of at most `step` [m], of second order. `coefficient`: f(glm::dvec3) [1/m],
/// scattering for the depth in which a path turns, extinction for the optical depth. `direction`:
/// unit; `step` > 0.
template <class Coefficient>
double probe_depth(const Coefficient& coefficient, const VolumeBox& box, glm::dvec3 x,
                   glm::dvec3 direction, double step) {
    const double length = exit_distance(box, x, direction);
    const double count = std::ceil(length / step);
    if (!(count > 0)) return 0;
    const double ds = length / count;
    double sum = 0;
    for (double i = 0; i < count; ++i) {
        sum += coefficient(x + (i + 0.5) * ds * direction);
    }
    return sum * ds;
}

/// Share of light that survives absorption below which a path is given up.
inline constexpr double kLeastSurvival = 1e-8;

/// int b e^-A kappa(ell) V(x) ds along a path: light that arrives from afar along the path's last
/// direction and is scattered for the last time on the path [1/sr, per unit irradiance measured
/// perpendicular to that direction]. `kernel`: double(double ell) [1/sr]; `visibility`:
/// double(glm::dvec3 x), the share of that light that reaches x unscattered, in [0, 1].
template <class Medium, class Kernel, class Visibility>
double gather_along_path(const QuasiPath& path, const Medium& medium, const MarchLimits& limits,
                         const Kernel& kernel, const Visibility& visibility) {
    double sum = 0;
    march_quasi_path(path, medium, limits, [&](const PathStep& step) {
        const double survival = std::exp(-step.absorption);
        if (step.depth > 0) {
            sum += step.depth * survival * kernel(step.ell) * visibility(step.position);
        }
        return survival > kLeastSurvival;
    });
    return sum;
}

}  // namespace opaline::bake
