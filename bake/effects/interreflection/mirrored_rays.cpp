#include "bake/effects/interreflection/mirrored_rays.h"

#include <algorithm>
#include <span>
#include <utility>

#include "bake/effects/interreflection/bounce_rays.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {

MirroredRay mirror(const formats::Scene& scene, const RayEnd& end, float share,
                   std::uint32_t number) {
    const formats::Material& material = scene.materials[end.material];
    if (!material.medium || material.sheet || !end.side.is_seen) {
        return {};
    }
    const auto cosine = static_cast<double>(std::clamp(end.side.cosine, 0.0f, 1.0f));
    const double reflectance =
        fresnel_reflectance(cosine, static_cast<double>(material.medium->eta));
    const glm::vec3 normal = end.side.normal;
    return {.origin = end.position + end.error * normal,
            .direction = glm::reflect(end.direction, normal),
            .share = share * static_cast<float>(reflectance),
            .number = number};
}

std::uint64_t follow_mirrored(const formats::Scene& scene, const RayScene& rays,
                              const BounceTree& tree, std::vector<MirroredRay> open,
                              std::vector<MirroredNode>& found) {
    // Boundaries that face each other mirror a few hundredths of what they were sent, but for
    // grazing angles.
    constexpr int kMostMirrors = 4;
    constexpr std::size_t kLanes = RayPacket::kSize;
    const auto add = [&](std::uint32_t node, const MirroredRay& ray) {
        if (node != formats::kNone) {
            found.push_back({node, ray.share, ray.number});
        }
    };
    std::uint64_t traced = 0;
    for (int mirrors = 0; mirrors < kMostMirrors && !open.empty(); ++mirrors) {
        std::vector<MirroredRay> next;
        for (std::size_t begin = 0; begin < open.size(); begin += kLanes) {
            const std::span<const MirroredRay> some =
                std::span(open).subspan(begin, std::min(kLanes, open.size() - begin));
            traced += some.size();
            const PacketHits hits = closest_of(rays, some);
            for (std::size_t i = 0; i < some.size(); ++i) {
                const MirroredRay& ray = some[i];
                if (hits.hit[i] == 0) {
                    add(tree.sky_node(ray.direction), ray);
                    continue;
                }
                const RayEnd end{.position = ray.origin + hits.distance[i] * ray.direction,
                                 .direction = ray.direction,
                                 .error = hits.error[i],
                                 .material = hits.material[i],
                                 .side = side_of_hit(scene, hits, i)};
                if (!end.side.is_seen) {
                    continue;
                }
                add(tree.find(end.position, {end.material, end.side.behind, end.side.normal}, 0),
                    ray);
                const MirroredRay on = mirror(scene, end, ray.share, ray.number);
                if (on.share > 0) {
                    next.push_back(on);
                }
            }
        }
        open = std::move(next);
    }
    return traced;
}

}  // namespace opaline::bake
