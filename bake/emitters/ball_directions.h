#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

struct Ball {
    glm::dvec3 centre{0};
    double radius = 0;  ///< [m], >= 0
};

/// Directions from a point to a ball: uniform over its cone; spread by the cosine over the horizon
/// where the cone is wider than pi, or the point is inside.
class BallDirections {
  public:
    BallDirections(const Ball& ball, const glm::dvec3& point, const glm::dvec3& normal);

    /// Unit; of two numbers in [0, 1). It may point below the horizon.
    glm::dvec3 sample(double u, double v) const;
    /// Density [1/sr] of a unit direction.
    double pdf(const glm::dvec3& direction) const;

  private:
    glm::dvec3 axis_{0};
    double cap_ = 0;  // 1 - cosine of the cone's half angle; 0: spread by the cosine
};

}  // namespace opaline::bake
