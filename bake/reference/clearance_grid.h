#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/reference/hit_scene.h"

namespace opaline::bake {

/// How far surfaces are at least, by cells of a grid: flights that are shorter need no ray. Deep in
/// a dense medium nearly all are, and the walk stays the same, bit by bit.
class ClearanceGrid {
  public:
    /// Knows nothing: 0 everywhere.
    ClearanceGrid() = default;
    /// Around all triangles, in cells of `cell` [m] > 0 or, if those would be too many, of a 128th
    /// of the longest side. Nothing is known of a scene of less than 8 cells, nor of one whose
    /// triangles lie in so many that looking for them would take longer than the rays it saves.
    ClearanceGrid(const HitScene& surfaces, float cell);

    /// Lower bound [m] of the distance from a position to the nearest triangle; 0 outside of the
    /// grid.
    float operator()(glm::vec3 position) const {
        const glm::vec3 place = (position - low_) * per_cell_;
        if (!(place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < count_.x &&
              place.y < count_.y && place.z < count_.z)) {
            return 0;
        }
        return cell_ * static_cast<float>(clear_[index(glm::uvec3(place))]);
    }

  private:
    std::size_t index(glm::uvec3 c) const {
        return (std::size_t{c.z} * size_.y + c.y) * size_.x + c.x;
    }
    bool mark_triangles(const HitScene& surfaces);
    void measure_distances();

    glm::vec3 low_{0}, count_{0};  ///< cells along each axis: size_ as floats
    glm::uvec3 size_{0};
    float cell_ = 0, per_cell_ = 0;
    std::vector<std::uint8_t> clear_;  ///< whole cells free of triangles on all sides of a cell
};

}  // namespace opaline::bake
