#include "bake/effects/interreflection/seen_light.h"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/bounce_rays.h"
#include "bake/effects/interreflection/mirrored_rays.h"
#include "bake/effects/interreflection/scatterers.h"

namespace opaline::bake {

std::vector<SeenNode> find_seen(const formats::Scene& scene, const RayScene& rays,
                                const BounceTree& tree, std::span<const SurfaceView> views,
                                double solid_angle, std::uint64_t& traced) {
    constexpr std::size_t kLanes = RayPacket::kSize;
    constexpr float kGrazing = 1e-2f;
    std::vector<SeenNode> seen;
    std::vector<MirroredRay> mirrored;
    seen.reserve(views.size());
    for (std::size_t begin = 0; begin < views.size(); begin += kLanes) {
        const std::span<const SurfaceView> some =
            views.subspan(begin, std::min(kLanes, views.size() - begin));
        const PacketHits hits = closest_of(rays, some);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const SeenSide side = hits.hit[i] != 0 ? side_of_hit(scene, hits, i) : SeenSide{};
            if (!side.is_seen) {
                continue;
            }
            const float t = hits.distance[i];
            const float area =
                static_cast<float>(solid_angle) * t * t / std::max(side.cosine, kGrazing);
            const std::uint32_t node =
                tree.find(some[i].origin + t * some[i].direction,
                          {hits.material[i], side.behind, side.normal}, area);
            if (node != formats::kNone) {
                seen.push_back({node, static_cast<std::uint32_t>(begin + i), 1});
            }
            const MirroredRay ray =
                mirror(scene,
                       {some[i].origin + t * some[i].direction, some[i].direction, hits.error[i],
                        hits.material[i], side},
                       1, static_cast<std::uint32_t>(begin + i));
            if (ray.share > 0) {
                mirrored.push_back(ray);
            }
        }
    }
    std::vector<MirroredNode> found;
    traced += views.size() + follow_mirrored(scene, rays, tree, std::move(mirrored), found);
    for (const MirroredNode& other : found) {
        seen.push_back({other.node, other.number, other.share});
    }
    std::ranges::stable_sort(seen, {}, &SeenNode::node);
    return seen;
}

std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows) {
    if (views.empty() || light.rays.is_empty()) {
        return 0;
    }
    std::uint64_t traced = 0;
    const std::vector<SeenNode> seen =
        find_seen(light.scene, light.rays, light.tree, views, solid_angle, traced);
    const std::size_t texels = light.tree.row_size() / light.bands;
    const std::size_t terms = views.front().factor.size();
    std::vector<float> planes(terms * bands * texels), factor(terms * bands);
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        std::ranges::fill(factor, 0.0f);
        for (end = begin; end < seen.size() && seen[end].node == seen[begin].node; ++end) {
            const SurfaceView& view = views[seen[end].view];
            for (std::size_t k = 0; k < factor.size(); ++k) {
                factor[k] += std::numbers::inv_pi_v<float> * view.factor[k / bands] *
                             view.weight[k % bands] * seen[end].share;
            }
        }
        const std::vector<float> row = light.tree.rows().row(seen[begin].node);
        for (std::size_t k = 0; k < factor.size(); ++k) {
            const float* const from =
                &row[std::min<std::size_t>(k % bands, light.bands - 1) * texels];
            float* const to = &planes[k * texels];
            for (std::size_t t = 0; t < texels; ++t) {
                to[t] += factor[k] * from[t];
            }
        }
    }
    add_to_finer(planes, light.cubemap_size, rows, cubemap_size,
                 static_cast<std::uint32_t>(terms * bands));
    return traced;
}

}  // namespace opaline::bake
