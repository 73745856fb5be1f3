#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "runtime/picture/projection.h"

namespace opaline::runtime {

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
