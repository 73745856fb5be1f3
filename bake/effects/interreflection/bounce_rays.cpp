#include "bake/effects/interreflection/bounce_rays.h"

namespace opaline::bake {

BounceGrid make_bounce_grid(std::uint32_t count) {
    BounceGrid grid;
    grid.side = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<float>(count))));
    grid.rays = count;
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

BounceGrid make_cut_grid(std::uint32_t count) {
    constexpr std::uint32_t kFewest = 256;
    constexpr double kCells = 0.64;
    if (count < kFewest) {
        return make_bounce_grid(count);
    }
    BounceGrid grid = make_bounce_grid(count_bounce_rays(kCells * count));
    grid.quarters = make_bounce_grid(4 * grid.count()).cells;
    grid.rays = count;
    return grid;
}

}  // namespace opaline::bake
