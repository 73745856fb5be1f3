#include "bake/effects/volumes/walk_nodes.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/volumes/volume_effects.h"

namespace opaline::bake {
namespace {

WalkedNode walk_node(const VolumeWalkSpace& walks, const WalkReceiver& receiver,
                     std::uint64_t& rays) {
    const std::size_t planes = receiver.terms * walks.space.bands();
    WalkedNode node;
    node.rows.resize(planes * walks.cells.size());
    std::vector<float> odd(node.rows.size());
    rays += gather_walks(walks, receiver, node.rows, odd);
    node.half[1] = reduce_rows(odd, planes, walks.cells.n);
    node.half[0] = reduce_rows(node.rows, planes, walks.cells.n);
    const std::uint32_t every_other = receiver.walks / 2;
    const auto all = static_cast<float>(receiver.walks),
               odd_walks = static_cast<float>(every_other);
    for (std::size_t i = 0; i < node.half[0].size(); ++i) {
        float& even = node.half[0][i];
        even = (all * even - odd_walks * node.half[1][i]) / (all - odd_walks);
    }
    return node;
}

}  // namespace

double walked_row_bytes(Quality quality, double nodes, double terms, double row) {
    constexpr double kMost = 1e9;
    const double bytes = nodes * terms * row * sizeof(float);
    return quality <= Quality::preview && bytes <= kMost ? bytes : 0;
}

WalkReceiver walk_receiver(const VolumeJob& job, const PlacedNodes& nodes, std::size_t number) {
    const NodePlace place = find_place(job, nodes, number);
    const VolumeLayout& layout = *place.layout;
    return {layout.volume,
            number,
            position_of(job, nodes, layout.volume, place.node),
            layout.walks,
            layout.often_terms,
            layout.sees_sky && layout.method != VolumeMethod::path_integration,
            layout.sees_surfaces};
}

std::vector<WalkedLayout> walk_nodes(const VolumeJob& job, const PlacedNodes& nodes,
                                     const VolumeWalkSpace& walks, const Context& context,
                                     std::uint64_t& rays) {
    std::vector<WalkedLayout> all(job.layouts.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const VolumeLayout& layout = job.layouts[i];
        const NodeLattice& lattice = nodes.lattices[layout.volume];
        const auto row = static_cast<double>(nodes.space.bands() * nodes.coarse.size());
        if (layout.method != VolumeMethod::walks || layout.walks < 2 ||
            walked_row_bytes(job.knobs.quality, static_cast<double>(lattice.node.size()),
                             layout.often_terms, row) <= 0) {
            continue;
        }
        WalkedLayout& own = all[i];
        struct Block {
            std::vector<WalkedNode> nodes;
            std::uint64_t rays = 0;
        };
        const std::size_t first = nodes.first[layout.volume];
        for_each_block_in_order(
            lattice.node.size(), kNodesAtOnce, context,
            [&](Range range) {
                Block block;
                for (std::size_t node = range.begin; node < range.end; ++node) {
                    block.nodes.push_back(
                        walk_node(walks, walk_receiver(job, nodes, first + node), block.rays));
                }
                return block;
            },
            [&](Range range, Block&& block) {
                std::ranges::move(block.nodes, std::back_inserter(own.nodes));
                rays += block.rays;
                if (context.on_progress) {
                    context.on_progress(
                        {scattering_stage(job.layouts), first + range.end, nodes.count});
                }
            });
        if (context.cancelled()) break;
        own.pairs = find_node_pairs(lattice, nodes.density[layout.volume],
                                    job.scene.volumes[layout.volume].density.to_scene, job.rays);
        own.smoothing = choose_smoothing(own.nodes, own.pairs, nodes.density[layout.volume],
                                         layout.often_terms, context);
    }
    return all;
}

}  // namespace opaline::bake
