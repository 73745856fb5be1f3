#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Lower bounds on the distance to the nearest surface inside a box, per cell of a grid; surfaces
/// outside the box do not count. A shorter flight needs
/// no ray, which holds for nearly all flights deep in a dense medium. The results keep the same
/// bits.
class ClearanceGrid {
  public:
    /// The trivial bound: 0 everywhere.
    ClearanceGrid() = default;
    static constexpr std::uint32_t kMostCells = 128;

    /// Of all triangles, inside a box given by its middle and half its size [m], in cells of `cell`
    /// [m] > 0 or, if that makes more than `most` (up to 1024) along the longest side, as wide as
    /// that many allow. The bound is 0 for boxes of fewer than 8 cells, and where triangles lie in
    /// so many cells that the grid would cost more than the rays that it saves.
    ClearanceGrid(const formats::Scene& scene, glm::vec3 centre, glm::vec3 half_size, float cell,
                  std::uint32_t most = kMostCells);

    /// Lower bound [m] of the distance from a position to the nearest triangle; 0 outside of the
    /// grid.
    float operator()(glm::vec3 position) const {
        const glm::vec3 place = (position - low_) * per_cell_;
        if (!(place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < count_.x &&
              place.y < count_.y && place.z < count_.z)) {
            return 0;
        }
        return step_ * static_cast<float>(clear_[index(glm::uvec3(place))]);
    }

  private:
    std::size_t index(glm::uvec3 c) const {
        return (std::size_t{c.z} * size_.y + c.y) * size_.x + c.x;
    }
    bool mark_triangles(const formats::Scene& scene);
    void measure_distances();
    void measure_along(int axis, std::vector<float>& square) const;

    glm::vec3 low_{0}, count_{0};  ///< cells along each axis: size_ as floats
    glm::uvec3 size_{0};
    float cell_ = 0, per_cell_ = 0, step_ = 0;
    std::vector<std::uint8_t> clear_;  ///< steps to the nearest triangle, of any place in a cell
};

}  // namespace opaline::bake
