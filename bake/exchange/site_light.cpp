#include "bake/exchange/site_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/scatterers.h"

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
    // Those that are not 0.
    void drop(std::span<const std::uint8_t> dropped) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (dropped[i] == 0) {
                at[kept] = at[i];
                points[kept++] = points[i];
            }
        }
        at.resize(kept);
        points.resize(kept);
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
    all.drop(is_copy);
}

// The first level of sites is as dense as receivers. A second level adds every second receiver
// where the first is too sparse: such a site costs a quarter of a receiver's rays and saves its
// neighbours theirs. A third level would cost as much as it saves.
constexpr int kSiteLevels = 2;

// Receivers where other light matters.
Candidates find_candidates(const LightInputs& inputs) {
    Candidates all;
    for (const ReceiverSet& set : inputs.bake.receivers) {
        if (inputs.acts.empty() || inputs.acts[set.material] != 0) {
            for (const Receiver& at : set.outside) {
                all.add(at, set.material);
            }
        }
    }
    drop_copies(all);
    return all;
}

// Receivers that have too few sites around.
Candidates find_unknown(const LightInputs& inputs, const BounceLight& light,
                        const Candidates& all) {
    Candidates unknown;
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        all.at.size(), kBlock, inputs.context,
        [&](Range range) {
            std::vector<std::size_t> found;
            std::vector<SiteWeight> weights;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                if (!light.sites.weigh(all.at[i], light.most_noise(light.of_receiver), weights)) {
                    found.push_back(i);
                }
            }
            return found;
        },
        [&](Range, const std::vector<std::size_t>& found) {
            for (const std::size_t i : found) {
                unknown.at.push_back(all.at[i]);
                unknown.points.push_back(all.points[i]);
            }
        });
    return unknown;
}

// Gathers light at sites of which `done` have it.
void light_new_sites(const LightInputs& inputs, BounceLight& light, std::vector<GatherSite>& sites,
                     std::size_t done, std::uint64_t& rays) {
    const std::size_t size = light.tree.row_size();
    light.site_rows.resize(sites.size());
    constexpr std::size_t kBlock = 16;
    for_each_block_in_order(
        sites.size() - done, kBlock, inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            std::vector<NodeWeight> weights;
            std::vector<float> row(size);
            for (std::size_t i = done + range.begin; i < done + range.end; ++i) {
                const BounceGather gathered = weigh_bounces(light.space(), light.tree, sites[i].at,
                                                            light.of_site, light.seed, weights);
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
}

}  // namespace

void light_sites(const LightInputs& inputs, BounceLight& light, std::uint64_t& rays) {
    Candidates unknown = find_candidates(inputs);
    // Rays of their own cost less for few.
    if (unknown.at.size() < kFewestWithSites) return;
    light.site_rows = CodedRows(0, light.tree.row_size());
    std::vector<GatherSite> sites;
    std::size_t wanted = kMostSites;
    for (int level = 0; level < kSiteLevels && wanted > 0; ++level) {
        const std::size_t done = sites.size();
        std::vector<std::uint8_t> is_site(unknown.at.size());
        for (const std::uint32_t i : choose_evenly(unknown.points, wanted)) {
            sites.push_back({unknown.at[i], 0});
            is_site[i] = 1;
        }
        unknown.drop(is_site);
        light_new_sites(inputs, light, sites, done, rays);
        light.sites = GatherSites(sites);
        if (level + 1 < kSiteLevels) {
            unknown = find_unknown(inputs, light, unknown);
            wanted = unknown.at.size() / 2;
        }
    }
}

}  // namespace opaline::bake
