#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// A vertex on the sample grid in homogeneous coordinates: column = x / w and row = y / w count
/// samples from the top left corner, w is the distance along the view axis. Finite, or skipped.
struct GridVertex {
    double x = 0, y = 0, w = 0;
};

/// A triangle that may cover samples: rows first_row to last_row, inclusive.
struct GridTriangle {
    std::array<std::uint32_t, 3> vertex{};  ///< in the whole asset's numbering
    std::uint32_t primitive = 0;
    std::uint32_t first_row = 0, last_row = 0;
};

/// Where the samples of a picture lie: centres at half-integers on a columns x rows grid.
struct SampleGrid {
    std::uint32_t columns = 0, rows = 0;
    double near_plane = 0;
};

std::vector<GridVertex> project_vertices(std::span<const formats::Vec3> positions,
                                         const Camera& camera, const SampleGrid& grid);

/// All triangles of the asset that reach into the picture beyond the near plane and show the eye
/// their front, or are of a primitive that shows its back (PrimitiveRecord::shows_back), in the
/// order of the file.
std::vector<GridTriangle> select_triangles(const formats::AssetView& asset,
                                           std::span<const GridVertex> vertices,
                                           const SampleGrid& grid);

/// The part of a triangle beyond the near plane, as a box on the grid; empty if low > high.
struct GridBox {
    double low_x = HUGE_VAL, low_y = HUGE_VAL, high_x = -HUGE_VAL, high_y = -HUGE_VAL;
};
GridBox visible_box(const std::array<GridVertex, 3>& corner, double near_plane);

/// First and one past the last sample whose centre lies in [low, high], within [0, limit].
struct SampleRange {
    std::uint32_t first = 0, end = 0;
};
SampleRange samples_within(double low, double high, std::uint32_t limit);

}  // namespace opaline::runtime
