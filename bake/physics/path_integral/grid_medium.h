#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

#include "formats/sparse_grid.h"

namespace opaline::bake {

/// What a medium does to light at one point, for one band. The functions of this room take a medium
/// as any callable `Coefficients medium(glm::dvec3 position)`, finite everywhere.
struct Coefficients {
    double scattering = 0;  ///< b [1/m], >= 0
    double absorption = 0;  ///< a [1/m], >= 0

    double extinction() const { return scattering + absorption; }  ///< c [1/m]
};

/// A box with faces perpendicular to the axes [m]; its faces belong to it.
struct VolumeBox {
    glm::dvec3 low{0}, high{0};

    bool contains(glm::dvec3 x) const {
        return x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y &&
               x.z <= high.z;
    }
};

/// Distance [m] from `x` in the box along the unit vector `direction` to where the ray leaves it,
/// >= 0; 0 from a face outward. Finite if the box is.
inline double exit_distance(const VolumeBox& box, glm::dvec3 x, glm::dvec3 direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        // A ray parallel to two faces never meets them: 0 / 0 on the face itself.
        if (direction[axis] != 0) {
            const double face = direction[axis] > 0 ? box.high[axis] : box.low[axis];
            nearest = std::min(nearest, (face - x[axis]) / direction[axis]);
        }
    }
    return std::max(nearest, 0.0);
}

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
