#pragma once

#include <glm/glm.hpp>

#include "bake/physics/path_integral/volume_box.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

/// A medium of constant albedo whose density is a grid. Refers to the grid, which must stay.
class GridMedium {
  public:
    /// `unit`: coefficients [1/m] where the density is 1. A transform that scales does not change
    /// them: lengths are those of the scene.
    GridMedium(const formats::SparseGrid<float>& density, Coefficients unit)
        : density_(density), to_index_(glm::inverse(density.to_scene)), unit_(unit) {}

    /// `x` in the scene [m].
    Coefficients operator()(glm::dvec3 x) const {
        const auto density =
            static_cast<double>(density_.sample(glm::vec3(to_index_ * glm::dvec4(x, 1))));
        return {unit_.scattering * density, unit_.absorption * density};
    }

  private:
    const formats::SparseGrid<float>& density_;
    glm::dmat4x3 to_index_;
    Coefficients unit_;
};

/// The smallest box in the scene that holds all points between voxels of the grid's table, one
/// voxel around them included: the density is 0 outside of it.
inline VolumeBox grid_box(const formats::SparseGrid<float>& grid) {
    constexpr int kSide = formats::SparseGrid<float>::kSide;
    const glm::dvec3 low = glm::dvec3(kSide * grid.first_brick) - 1.0;
    const glm::dvec3 high = kSide * (grid.first_brick + grid.extent);
    VolumeBox box;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index((corner & 1) != 0 ? high.x : low.x,
                               (corner & 2) != 0 ? high.y : low.y,
                               (corner & 4) != 0 ? high.z : low.z);
        const glm::dvec3 x(grid.to_scene * glm::dvec4(index, 1));
        box.low = corner == 0 ? x : glm::min(box.low, x);
        box.high = corner == 0 ? x : glm::max(box.high, x);
    }
    return box;
}

}  // namespace opaline::bake
