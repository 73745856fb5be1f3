#include "bake/effects/interreflection/site_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/even_choice.h"

namespace opaline::bake {
namespace {

struct Candidates {
    std::vector<Receiver> at;
    std::vector<SidePoint> points;

    void add(const Receiver& own, std::uint32_t material) {
        if (own.normal != glm::vec3(0)) {
            at.push_back(own);
            points.push_back({own.origin, {material, false, own.normal}});
        }
    }
};

// Copies of a vertex would count as if each had rays of its own.
void drop_copies(Candidates& all) {
    std::vector<std::pair<std::uint64_t, std::size_t>> keys;
    keys.reserve(all.at.size());
    for (std::size_t i = 0; i < all.at.size(); ++i) {
        keys.emplace_back(key_of(all.at[i]), i);
    }
    std::ranges::sort(keys);
    std::vector<std::uint8_t> is_copy(all.at.size());
    for (std::size_t i = 1; i < keys.size(); ++i) {
        is_copy[keys[i].second] = keys[i].first == keys[i - 1].first ? 1 : 0;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.at.size(); ++i) {
        if (is_copy[i] == 0) {
            all.at[kept] = all.at[i];
            all.points[kept++] = all.points[i];
        }
    }
    all.at.resize(kept);
    all.points.resize(kept);
}

// Evenly spaced ones of the receivers, as dense as these. None where they are so few that rays of
// their own cost less.
std::vector<GatherSite> choose_sites(const LightInputs& inputs) {
    Candidates all;
    for (const ReceiverSet& set : inputs.bake.receivers) {
        if (inputs.acts.empty() || inputs.acts[set.material] != 0) {
            for (const Receiver& at : set.outside) {
                all.add(at, set.material);
            }
        }
    }
    drop_copies(all);
    std::vector<GatherSite> sites;
    if (all.at.size() >= kFewestWithSites) {
        for (const std::uint32_t i : choose_evenly(all.points, kMostSites)) {
            sites.push_back({all.at[i], 0});
        }
    }
    return sites;
}

}  // namespace

void light_sites(const LightInputs& inputs, BounceLight& light, std::uint64_t& rays) {
    std::vector<GatherSite> sites = choose_sites(inputs);
    const std::size_t size = light.tree.row_size();
    light.site_rows = CodedRows(sites.size(), size);
    constexpr std::size_t kBlock = 16;
    for_each_block_in_order(
        sites.size(), kBlock, inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            std::vector<NodeWeight> weights;
            std::vector<float> row(size);
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const BounceGather gathered =
                    weigh_bounces(light.scene, light.rays, light.tree, sites[i].at, light.of_site,
                                  light.seed, weights);
                traced += gathered.rays;
                sites[i].clearance = gathered.nearness > 0 ? 1 / std::sqrt(gathered.nearness)
                                                           : std::numeric_limits<float>::infinity();
                std::ranges::fill(row, 0.0f);
                add_node_rows(light.tree, weights, row);
                light.site_rows.set(i, row);
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    light.sites = GatherSites(std::move(sites));
}

}  // namespace opaline::bake
