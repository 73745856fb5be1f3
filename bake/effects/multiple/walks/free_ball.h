#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace opaline::bake {

/// The ball around a known place that holds no triangle, and what follows for other places: bounds
/// on their distance [m] to the nearest triangle.
class FreeBall {
  public:
    /// `radius`: a lower bound on the distance at `centre`; `most`: an upper bound, infinity where
    /// nothing was found.
    void set(glm::vec3 centre, float radius, float most) {
        centre_ = centre;
        radius_ = radius;
        most_ = most;
    }

    float least(glm::vec3 position) const { return radius_ - glm::distance(position, centre_); }
    float most(glm::vec3 position) const { return most_ + glm::distance(position, centre_); }

  private:
    glm::vec3 centre_{0};
    float radius_ = 0, most_ = std::numeric_limits<float>::infinity();
};

}  // namespace opaline::bake
