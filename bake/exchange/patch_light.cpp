#include "bake/exchange/patch_light.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>

#include "bake/transport/packet_lane.h"
#include "formats/opal/asset.h"

namespace opaline::bake {
namespace {

std::uint32_t nearest_scatterer(const PatchLight::Scatterers& points, const Receiver& at) {
    float least = std::numeric_limits<float>::max();
    std::uint32_t nearest = formats::kNone;
    for (const std::uint32_t material : points.materials) {
        const std::uint32_t node = points.tree.find(at.origin, {material, false, at.normal}, 0);
        if (node == formats::kNone) continue;
        const std::uint32_t found = points.tree.scatterer_of(node);
        const glm::vec3 d = points.all[found].position - at.origin;
        if (glm::dot(d, d) < least) {
            least = glm::dot(d, d);
            nearest = found;
        }
    }
    if (nearest != formats::kNone) return nearest;
    // No scatterer faces that way.
    nearest = points.members.front();
    for (const std::uint32_t i : points.members) {
        const glm::vec3 d = points.all[i].position - at.origin;
        const float square =
            glm::dot(d, d) * (glm::dot(points.all[i].normal, at.normal) > 0 ? 1.0f : 4.0f);
        if (square < least) {
            least = square;
            nearest = i;
        }
    }
    return nearest;
}

std::uint32_t receiver_below(const PatchLight::Receivers& points, const Receiver& at) {
    const PacketHits hits = closest_of_one(points.rays, at.origin, -at.normal);
    const auto own = hits.hit[0] == 0 ? points.primitives.end()
                                      : std::ranges::find(points.primitives, hits.primitive[0]);
    if (own == points.primitives.end()) return formats::kNone;
    const std::array<float, 3> weight{1 - hits.u[0] - hits.v[0], hits.u[0], hits.v[0]};
    const auto corner = static_cast<std::size_t>(std::ranges::max_element(weight) - weight.begin());
    return points.first[static_cast<std::size_t>(own - points.primitives.begin())] +
           points.scene.primitives[*own].index[hits.first_index[0] + corner];
}

}  // namespace

std::uint64_t add_patch(const PatchLight& light, const Receiver& at, std::span<float> row) {
    const auto* const receivers = std::get_if<PatchLight::Receivers>(&light.points);
    const std::uint32_t point =
        receivers != nullptr
            ? receiver_below(*receivers, at)
            : nearest_scatterer(std::get<PatchLight::Scatterers>(light.points), at);
    if (point != formats::kNone) row[light.patch[point]] += 1;
    return receivers != nullptr ? 1 : 0;
}

}  // namespace opaline::bake
