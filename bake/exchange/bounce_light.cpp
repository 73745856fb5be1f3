#include "bake/exchange/bounce_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/site_light.h"
#include "bake/exchange/solve_bounces.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
std::uint32_t count_rays_of_site(std::uint32_t of_receiver) {
    constexpr double kShare = 0.25;
    return count_bounce_rays(kShare * of_receiver);
}

std::size_t count_scatterers(std::uint32_t rays_of_receiver) {
    constexpr double kPerRay = 64, kFewest = 1024, kMost = 24576;
    return static_cast<std::size_t>(std::clamp(kPerRay * rays_of_receiver, kFewest, kMost));
}

std::shared_ptr<const BounceLight> solve_exchange(const LightInputs& inputs, ExchangePoints points,
                                                  std::span<const MediumRows> media,
                                                  std::uint64_t& rays, Bounces bounces) {
    const std::uint32_t count = inputs.rays_of_receiver;
    const std::span<const Scatterer> scatterers = points.scatterers;
    if (scatterers.empty()) return nullptr;
    const bool is_coloured =
        bounces != Bounces::all || std::ranges::any_of(inputs.layouts, &RowLayout::coloured);
    ScattererLight own = light_scatterers(inputs, points, media, is_coloured ? 3 : 1, rays);
    auto light = std::make_shared<BounceLight>(
        BounceLight{.scene = inputs.bake.scene,
                    .rays = inputs.bake.rays,
                    .cubemap_size = kBounceCubemap,
                    .bands = own.bands,
                    .seed = inputs.knobs.seed,
                    .layouts = {inputs.layouts.begin(), inputs.layouts.end()},
                    .tree = BounceTree(scatterers, inputs.layouts.size(), own.row_size()),
                    .transfer = {},
                    .of_site = make_bounce_grid(count_rays_of_site(count)),
                    .of_receiver = make_cut_grid(count),
                    .of_averaged = make_bounce_grid(kRaysOfAveraged),
                    .sites = {},
                    .site_rows = {}});
    Transfer& transfer = light->transfer;
    if (bounces != Bounces::none || own.crossing.count() > 0) {
        transfer.arrivals = weigh_scatterers(inputs, scatterers, media, light->tree, own, rays);
    }
    transfer.answers = std::move(own.answers);
    transfer.scatterers = std::move(points.scatterers);
    if (bounces == Bounces::all) {
        light->report = add_bounces(transfer, own.emitted, own.bands, light->tree, inputs.context);
        light_sites(inputs, *light, rays);
    } else {
        light->tree.set_rows(own.emitted, inputs.context);
    }
    return light;
}

std::vector<SeenNode> find_seen(const BounceSpace& space, const BounceTree& tree,
                                std::span<const SurfaceView> views, double solid_angle,
                                std::uint64_t& traced) {
    constexpr std::size_t kLanes = RayPacket::kSize;
    constexpr float kGrazing = 1e-2f;
    std::vector<SeenNode> seen;
    std::vector<MirroredRay> mirrored;
    seen.reserve(views.size());
    for (std::size_t begin = 0; begin < views.size(); begin += kLanes) {
        const std::span<const SurfaceView> some =
            views.subspan(begin, std::min(kLanes, views.size() - begin));
        const PacketHits hits = closest_of(space.rays, some);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const SeenSide side = hits.hit[i] != 0 ? side_of_hit(space.scene, hits, i) : SeenSide{};
            if (!side.is_seen) continue;
            const float t = hits.distance[i];
            const float area =
                static_cast<float>(solid_angle) * t * t / std::max(side.cosine, kGrazing);
            const RayEnd end = end_of_ray(space.scene, some[i].origin, some[i].direction, hits, i);
            const auto view = static_cast<std::uint32_t>(begin + i);
            const MirroredRay ray = mirror(space, end, {1, 1, 1}, view);
            const std::uint32_t node = tree.find(end.position - end.triangle.offset,
                                                 {end.material, side.behind, side.normal}, area);
            if (node != formats::kNone) {
                const float share = share_of_own(space, tree, node, end, ray);
                seen.push_back({node, view, {share, share, share}});
            }
            if (ray.largest() > 0) {
                mirrored.push_back(ray);
            }
        }
    }
    std::vector<MirroredNode> found;
    traced += views.size() + follow_mirrored(space, tree, std::move(mirrored), found);
    for (const MirroredNode& other : found) {
        seen.push_back({other.node, other.number, other.share});
    }
    std::ranges::stable_sort(seen, {}, &SeenNode::node);
    return seen;
}

std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows) {
    if (views.empty() || light.rays.is_empty()) return 0;
    std::uint64_t traced = 0;
    const std::vector<SeenNode> seen =
        find_seen(light.space(), light.tree, views, solid_angle, traced);
    const std::size_t texels = light.tree.row_size() / light.bands;
    const std::size_t terms = views.front().factor.size();
    std::vector<float> planes(terms * bands * texels), factor(terms * bands);
    // By way of lobes, which see much of it: texels of the sky become one row.
    std::vector<float> sky(light.tree.has_lobes() ? planes.size() : 0);
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        std::ranges::fill(factor, 0.0f);
        for (end = begin; end < seen.size() && seen[end].node == seen[begin].node; ++end) {
            const SurfaceView& view = views[seen[end].view];
            const BandColour share =
                in_bands({seen[end].share.r, seen[end].share.g, seen[end].share.b}, bands);
            for (std::size_t k = 0; k < factor.size(); ++k) {
                factor[k] += std::numbers::inv_pi_v<float> * view.factor[k / bands] *
                             view.weight[k % bands] * share[k % bands];
            }
        }
        if (!sky.empty() && light.tree.is_sky(seen[begin].node)) {
            for (std::size_t k = 0; k < factor.size(); ++k) {
                light.tree.add_sky(seen[begin].node, factor[k],
                                   std::span(sky).subspan(k * texels, texels));
            }
            continue;
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
    for (std::size_t begin = 0; begin < sky.size(); begin += texels) {
        const std::span<float> plane = std::span(sky).subspan(begin, texels);
        formats::haar_forward_cube(plane, light.cubemap_size);
        for (std::size_t t = 0; t < texels; ++t) {
            planes[begin + t] += plane[t];
        }
    }
    add_to_finer(planes, light.cubemap_size, rows, cubemap_size,
                 static_cast<std::uint32_t>(terms * bands));
    return traced;
}

std::uint64_t add_bounced(const BounceLight& light, const LitPoint& point,
                          std::uint32_t cubemap_size, std::span<float> rows) {
    const BounceGrid& own = point.is_averaged ? light.of_averaged : light.of_receiver;
    std::vector<float> sum(light.tree.row_size());
    const float most = light.most_noise(own);
    std::vector<SiteWeight> around;
    std::uint64_t rays = 0;
    if (light.sites.weigh(point.receiver, most, around)) {
        for (const SiteWeight& w : around) {
            light.site_rows.add(w.site, w.weight, sum);
        }
    } else {
        std::vector<NodeWeight> weights;
        rays =
            weigh_bounces(light.space(), light.tree, point.receiver, own, light.seed, weights).rays;
        add_node_rows(light.tree, weights, sum);
    }
    add_to_finer(sum, light.cubemap_size, rows, cubemap_size, light.bands);
    return rays;
}

}  // namespace opaline::bake
