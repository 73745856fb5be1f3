#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/environment.h"

namespace opaline::runtime {

/// Where the pixels of an environment map lie. A pixel's *cell* is the part of the sphere nearer to
/// its centre than to its neighbours' along rows and columns; cells cover the sphere exactly.

/// Polar angles [rad] between the rows of a lat-long map, from 0 to pi: height + 1 values.
std::vector<double> row_edges(const formats::Environment& map);

/// Solid angle [sr] of the cell of a pixel; `edges` as from row_edges for lat-long maps, unused for
/// cube maps. `row` counts all rows of the image.
double cell_solid_angle(const formats::Environment& map, const std::vector<double>& edges,
                        std::uint32_t column, std::uint32_t row);

/// Smaller and larger side of a pixel [rad], where pixels are largest.
struct PixelSize {
    double smaller = 0, larger = 0;
};
PixelSize pixel_size(const formats::Environment& map);

}  // namespace opaline::runtime
