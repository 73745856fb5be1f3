#include "bake/exchange/patch_light.h"

#include <glm/glm.hpp>
#include <limits>

#include "formats/opal/asset.h"

namespace opaline::bake {
namespace {

std::uint32_t nearest_scatterer(const PatchLight& points, const Receiver& at) {
    float least = std::numeric_limits<float>::max();
    std::uint32_t nearest = formats::kNone;
    for (const std::uint32_t material : points.materials) {
        const std::uint32_t node = points.tree.find(at.origin, {material, false, at.normal}, 0);
        if (node == formats::kNone) continue;
        const std::uint32_t found = points.tree.scatterer_of(node);
        const glm::vec3 d = points.scatterers[found].position - at.origin;
        if (glm::dot(d, d) < least) {
            least = glm::dot(d, d);
            nearest = found;
        }
    }
    if (nearest != formats::kNone) return nearest;
    // No scatterer faces that way.
    nearest = points.members.front();
    for (const std::uint32_t i : points.members) {
        const glm::vec3 d = points.scatterers[i].position - at.origin;
        const float square =
            glm::dot(d, d) * (glm::dot(points.scatterers[i].normal, at.normal) > 0 ? 1.0f : 4.0f);
        if (square < least) {
            least = square;
            nearest = i;
        }
    }
    return nearest;
}

}  // namespace

void add_patch(const PatchLight& light, const Receiver& at, std::span<float> row) {
    row[light.patch[nearest_scatterer(light, at)]] += 1;
}

}  // namespace opaline::bake
