#include "bake/receivers/used_vertices.h"

#include <cstddef>
#include <numeric>

namespace opaline::bake {

std::vector<std::uint32_t> find_used_vertices(const formats::Scene& scene) {
    std::vector<std::uint32_t> used;
    std::uint32_t first = 0;
    for (const formats::Primitive& p : scene.primitives) {
        std::vector<bool> is_used(p.position.size(), false);
        for (const std::uint32_t vertex : p.index) {
            is_used[vertex] = true;
        }
        for (std::uint32_t v = 0; v < is_used.size(); ++v) {
            if (is_used[v]) {
                used.push_back(first + v);
            }
        }
        first += static_cast<std::uint32_t>(p.position.size());
    }
    if (used.empty()) {
        used.resize(first);
        std::iota(used.begin(), used.end(), 0u);
    }
    return used;
}

}  // namespace opaline::bake
