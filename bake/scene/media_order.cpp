#include "bake/scene/media_order.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

namespace opaline::bake {
namespace {

// Enclosed by all bodies of a material [m^3], in the digits that do not depend on how they are cut
// into triangles. About one of their corners, so that an open body far
// from the origin is no larger for that.
float enclosed_volume(const formats::Scene& scene, std::uint32_t material) {
    std::optional<glm::dvec3> origin;
    double volume = 0;
    for (const formats::Primitive& p : scene.primitives) {
        if (p.material != material) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const glm::dvec3 a(p.position[p.index[i]]);
            const glm::dvec3 b(p.position[p.index[i + 1]]), c(p.position[p.index[i + 2]]);
            origin = origin.value_or(a);
            volume += glm::dot(a - *origin, glm::cross(b - *origin, c - *origin)) / 6;
        }
    }
    return static_cast<float>(std::abs(volume));
}

}  // namespace

std::vector<std::uint32_t> order_media(const formats::Scene& scene) {
    std::vector<float> volume(scene.materials.size());
    std::vector<std::uint32_t> order;
    for (auto m = static_cast<std::uint32_t>(scene.materials.size()); m-- > 0;) {
        if (!scene.materials[m].medium) continue;
        volume[m] = enclosed_volume(scene, m);
        order.push_back(m);
    }
    std::ranges::stable_sort(
        order, [&](std::uint32_t a, std::uint32_t b) { return volume[a] > volume[b]; });
    return order;
}

}  // namespace opaline::bake
