#include "bake/receivers/used_vertices.h"

#include <cstddef>
#include <numeric>

namespace opaline::bake {

std::vector<std::uint32_t> find_used_vertices(const formats::Scene& scene,
                                              const formats::SlotsView& slots) {
    std::size_t count = slots.vertex.size();
    for (const formats::Primitive& p : scene.primitives) {
        count += slots.empty() ? p.position.size() : 0;
    }
    std::vector<bool> is_used(count, false);
    std::uint32_t first = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (const std::uint32_t vertex : p.index) {
            is_used[slots.empty() ? first + vertex : slots.slot[first + vertex]] = true;
        }
        first += static_cast<std::uint32_t>(p.position.size());
    }
    std::vector<std::uint32_t> used;
    for (std::uint32_t v = 0; v < count; ++v) {
        if (is_used[v]) used.push_back(v);
    }
    if (used.empty()) {
        used.resize(count);
        std::iota(used.begin(), used.end(), 0u);
    }
    return used;
}

}  // namespace opaline::bake
