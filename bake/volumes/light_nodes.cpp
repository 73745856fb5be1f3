#include "bake/volumes/light_nodes.h"

#include <algorithm>
#include <span>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/volumes/attenuation.h"

namespace opaline::bake {
namespace {

using formats::SparseRow;

// V of a node: its row, and its depths toward the coarse cells.
struct Lit {
    SparseRow row;
    std::vector<float> coarse;  // band after band
};

Lit light_node(const VolumeJob& job, const PlacedNodes& nodes, const NodePlace& place,
               std::uint64_t& rays) {
    const std::size_t bands = nodes.space.extinction_bands(), cells = nodes.fine.size();
    std::vector<float> fine(bands * cells);
    rays += gather_attenuation(nodes.space, job.rays, nodes.fine,
                               position_of(job, nodes, place.layout->volume, place.node), fine);
    Lit lit;
    for (std::size_t band = 0; band < bands; ++band) {
        const std::vector<float> own(
            fine.begin() + static_cast<std::ptrdiff_t>(band * cells),
            fine.begin() + static_cast<std::ptrdiff_t>((band + 1) * cells));
        const std::vector<float> reduced = reduce_cells(own, nodes.fine.n, nodes.coarse.n);
        lit.coarse.insert(lit.coarse.end(), reduced.begin(), reduced.end());
    }
    // The rows of a node have as many bands as any of them needs.
    const std::size_t known = fine.size();
    fine.resize(nodes.space.bands() * cells);
    for (std::size_t i = known; i < fine.size(); ++i) {
        fine[i] = fine[i - cells];
    }
    const auto row_bands = static_cast<std::uint32_t>(nodes.space.bands());
    scale_rows(nodes.albedo[place.layout->volume][place.node], row_bands, cells, fine);
    lit.row = std::move(encode_node_rows(nodes.attenuated[number_of(job, *place.layout)], fine, 1,
                                         nodes.fine.n, row_bands)
                            .front());
    return lit;
}

}  // namespace

LitNodes light_nodes(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                     std::uint64_t& rays) {
    LitNodes lit;
    lit.depths = make_depth_table(nodes.count, nodes.coarse.size(), nodes.space.extinction_bands());
    struct Block {
        std::vector<Lit> nodes;
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        nodes.count, kNodesAtOnce, context,
        [&](Range range) {
            Block block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.nodes.push_back(
                    light_node(job, nodes, find_place(job, nodes, i), block.rays));
            }
            return block;
        },
        [&](Range range, Block&& block) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                Lit& own = block.nodes[i - range.begin];
                const std::size_t cells = nodes.coarse.size();
                float most = 0;
                for (std::size_t band = 0; band < lit.depths.bands; ++band) {
                    const auto values = std::span(own.coarse).subspan(band * cells, cells);
                    set_depths(lit.depths, i, band, values);
                    most = std::max(most, *std::ranges::max_element(values));
                }
                lit.depths.is_dark[i] = most < 1e-6f;
                lit.row.push_back(std::move(own.row));
            }
            rays += block.rays;
            if (context.on_progress) {
                context.on_progress({"light in volumes", range.end, nodes.count});
            }
        });
    return lit;
}

}  // namespace opaline::bake
