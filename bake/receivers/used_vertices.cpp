#include "bake/receivers/used_vertices.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace opaline::bake {

std::vector<std::uint32_t> find_used_vertices(const formats::Scene& scene,
                                              const formats::SlotsView& slots) {
    std::size_t count = slots.mix.empty() ? slots.vertex.size() : 0;
    for (const std::uint32_t place : slots.place) {
        count = std::max<std::size_t>(count, place + std::size_t{1});
    }
    for (const formats::Primitive& p : scene.primitives) {
        count += slots.empty() ? p.position.size() : 0;
    }
    std::vector<bool> is_used(count, false);
    std::uint32_t first = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (const std::uint32_t vertex : p.index) {
            is_used[slots.empty()       ? first + vertex
                    : slots.mix.empty() ? slots.slot[first + vertex]
                                        : slots.place[first + vertex]] = true;
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
    if (slots.mix.empty()) return used;
    std::vector<std::uint32_t> slot_of(count);
    for (std::size_t v = 0; v < slots.place.size(); ++v) {
        slot_of[slots.place[v]] = slots.slot[v];
    }
    for (std::uint32_t& of_place : used) {
        of_place = slot_of[of_place];
    }
    return used;
}

}  // namespace opaline::bake
