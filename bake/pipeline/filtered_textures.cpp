#include "bake/pipeline/filtered_textures.h"

#include <algorithm>

namespace opaline::bake {

std::vector<std::uint8_t> filtered_materials(const formats::Scene& scene,
                                             std::span<const RowLayout> layouts, bool has_lamps) {
    std::vector<std::uint8_t> filtered(scene.materials.size());
    for (std::size_t m = 0; m < filtered.size(); ++m) {
        filtered[m] = has_lamps || layouts[m].filtered ? 1 : 0;
    }
    if (scene.images.empty() || std::ranges::count(filtered, 1) == 0) {
        filtered.clear();
    }
    return filtered;
}

}  // namespace opaline::bake
