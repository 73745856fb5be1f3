#include "bake/effects/interreflection/add_bounced.h"

#include <vector>

#include "bake/effects/interreflection/bounce_gather.h"

namespace opaline::bake {

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
        rays = weigh_bounces(light.scene, light.rays, light.tree, point.receiver, own, light.seed,
                             weights)
                   .rays;
        add_node_rows(light.tree, weights, sum);
    }
    add_to_finer(sum, light.cubemap_size, rows, cubemap_size, light.bands);
    return rays;
}

}  // namespace opaline::bake
