#include "bake/direct/bake_direct.h"

#include <numbers>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "formats/opal/haar.h"

namespace opaline::bake {

formats::SparseRows bake_direct(const RayScene& scene, const DirectionSet& directions,
                                const Selector& selector, std::uint32_t code_bits,
                                std::span<const Receiver> receivers, RowsDone done,
                                const Context& context, std::uint64_t& rays) {
    struct Block {
        formats::SparseRows rows;
        std::uint64_t rays = 0;
    };
    constexpr std::size_t kReceiversPerBlock = 64;
    formats::SparseRows rows = formats::make_sparse_rows(directions.cubemap_size, code_bits);
    for_each_block_in_order(
        receivers.size(), kReceiversPerBlock, context,
        [&](Range range) {
            Block block{formats::make_sparse_rows(directions.cubemap_size, code_bits), 0};
            std::vector<float> dense(selector.weight.size());
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.rays += gather_irradiance(scene, directions, receivers[i], dense);
                for (float& value : dense) {
                    value *= std::numbers::inv_pi_v<float>;
                }
                formats::haar_forward_cube(std::span<float>(dense), directions.cubemap_size);
                formats::append_row(block.rows, select_coefficients(selector, dense, 1));
            }
            return block;
        },
        [&](Range range, const Block& block) {
            formats::append_rows(rows, block.rows);
            rays += block.rays;
            if (context.on_progress) {
                context.on_progress({"direct", done.before + range.end, done.total});
            }
        });
    return rows;
}

}  // namespace opaline::bake
