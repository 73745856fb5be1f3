#include "runtime/clouds/map_cells.h"

namespace opaline::runtime {

std::optional<formats::Environment> refine_map(const formats::Environment& map) {
    constexpr double kLargest = 3 * std::numbers::pi / 180;
    if (pixel_size(map).larger <= kLargest) return std::nullopt;
    formats::Environment fine;
    fine.width = 256;
    fine.height = 128;
    fine.pixel.resize(std::size_t{fine.width} * fine.height);
    std::vector<formats::Rgb> pixel;
    pixel.reserve(fine.pixel.size());
    for_cells(fine, [&](formats::Rgb, formats::Vec3 direction, double) {
        pixel.push_back(formats::sample_map(map, direction));
    });
    fine.pixel = std::move(pixel);
    return fine;
}

}  // namespace opaline::runtime
