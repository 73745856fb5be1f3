#include "bake/effects/interreflection/bounce_rays.h"

namespace opaline::bake {

BounceGrid make_bounce_grid(std::uint32_t count) {
    BounceGrid grid;
    grid.side = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<float>(count))));
    grid.cells.reserve(count);
    const float width = 1 / static_cast<float>(grid.side);
    for (std::uint32_t row = 0; row < grid.side; ++row) {
        for (std::uint32_t column = 0; column < grid.side; ++column) {
            const float left = static_cast<float>(column) * width, right = left + width;
            const float low = static_cast<float>(row) * width, high = low + width;
            const float u = 0.5f * (left + right), v = 0.5f * (low + high);
            grid.cells.push_back(
                {.middle = to_hemisphere(u, v),
                 .across = to_hemisphere(std::min(right, 1.0f), v) - to_hemisphere(left, v),
                 .along = to_hemisphere(u, std::min(high, 1.0f)) - to_hemisphere(u, low)});
        }
    }
    return grid;
}

}  // namespace opaline::bake
