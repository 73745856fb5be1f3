#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
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

/// A horizontal band of the sample grid: which triangle each sample sees.
struct Band {
    static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t first_row = 0, rows = 0, columns = 0;
    std::vector<double> inverse_distance;  ///< 1 / w of what is seen, 0 where nothing is
    std::vector<std::uint32_t> triangle;   ///< index into the triangles, or kNothing
};

/// The row of pixels that a band of whole pixels begins with. `supersampling` >= 1.
inline std::uint32_t first_pixel_row(const Band& band, std::uint32_t supersampling) {
    return band.first_row / supersampling;
}

/// Empties the band and moves it to `first_row`.
void reset_band(Band& band, std::uint32_t first_row, std::uint32_t rows, std::uint32_t columns);

/// Edge functions of a triangle in homogeneous coordinates, which need no clipping: at sample
/// (x, y), e_i = a_i x + b_i y + c_i is proportional to barycentric coordinate i over w with one
/// common positive factor, so e_i / sum(e) interpolates with perspective correction.
/// (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997.)
struct EdgeFunctions {
    std::array<double, 3> a{}, b{}, c{};
    double inverse_determinant = 0;  ///< sum(e) times this is 1 / w; 0: the triangle is degenerate

    std::array<double, 3> at(double x, double y) const;
};
EdgeFunctions edge_functions(const std::array<GridVertex, 3>& corner);

/// Whether a sample, whose edge functions these are, sees a triangle that covers it.
using SampleTest = std::function<bool(const std::array<double, 3>& edges, std::uint32_t column,
                                      std::uint32_t row)>;

/// Draws triangle number `number` into the band: nearest wins, of equally near ones the first. A
/// sample on an edge belongs to exactly one of the two triangles that share it. `sees` empty: all
/// samples do.
void draw_triangle(Band& band, std::uint32_t number, const GridTriangle& triangle,
                   std::span<const GridVertex> vertices, const SampleGrid& grid,
                   const SampleTest& sees);

}  // namespace opaline::runtime
