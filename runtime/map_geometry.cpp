#include "runtime/map_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"

namespace opaline::runtime {

using formats::Environment;
using std::numbers::pi;

std::vector<double> row_edges(const Environment& map) {
    const std::uint32_t height = map.height;
    std::vector<double> edge(std::size_t{height} + 1);
    for (std::uint32_t e = 1; e < height; ++e) {
        edge[e] = map.rows_include_poles ? pi * (e - 0.5) / (height - 1) : pi * e / height;
    }
    edge[height] = pi;
    return edge;
}

double cell_solid_angle(const Environment& map, const std::vector<double>& edges,
                        std::uint32_t column, std::uint32_t row) {
    if (map.layout == Environment::Layout::cube) {
        const double step = 2.0 / map.width;
        const double u = column * step - 1.0, v = row % map.width * step - 1.0;
        return formats::rectangle_solid_angle(u, v, u + step, v + step);
    }
    // cos a - cos b without cancellation for the narrow bands near the poles.
    const double a = edges[row], b = edges[row + 1];
    return 2.0 * pi / map.width * 2.0 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));
}

PixelSize pixel_size(const Environment& map) {
    if (map.layout == Environment::Layout::cube) {
        return {2.0 / map.width, 2.0 / map.width};
    }
    const double across = 2.0 * pi / map.width, down = pi / map.height;
    return {std::min(across, down), std::max(across, down)};
}

}  // namespace opaline::runtime
