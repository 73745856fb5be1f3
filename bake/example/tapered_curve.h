#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace opaline::bake {

/// A smooth spine with a radius along it: a uniform cubic B-spline through its two end points. It
/// is twice differentiable, so a tube around it shows no rings.
class TaperedCurve {
  public:
    /// `control`: at least two points as (x, y, z, radius) [mm].
    explicit TaperedCurve(const std::vector<glm::dvec4>& control);

    struct Nearest {
        glm::dvec3 point;    ///< on the spine
        glm::dvec3 tangent;  ///< unit
        double radius;       ///< of the tube there
        double fraction;     ///< along the spine, 0 at its start, 1 at its end
    };
    /// The point of the spine nearest to `p`.
    Nearest nearest(const glm::dvec3& p) const;

    /// Signed distance to the tube, exact up to its taper.
    double distance(const glm::dvec3& p) const;

    /// A lower bound of the distance from `p` to the tube, cheap and tight for a nearly straight
    /// one.
    double distance_bound(const glm::dvec3& p) const;

  private:
    struct Point {
        glm::dvec4 value, first, second;
    };
    Point evaluate(double t) const;

    std::vector<std::array<glm::dvec4, 4>> spans_;  ///< polynomials, constant term first
    std::vector<glm::dvec3> samples_;  ///< even in the parameter: where the search begins
    double reach_ = 0.0;               ///< largest distance of a point of the tube from its chord
    double chord_distance(const glm::dvec3& p) const;
};

}  // namespace opaline::bake
