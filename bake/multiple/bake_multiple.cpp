#include "bake/multiple/bake_multiple.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {

formats::SparseRows bake_multiple(const ClusterTree& tree, const GatherProfile& profile,
                                  double exit, const GatherOptions& options,
                                  const Selector& selector, std::uint32_t code_bits,
                                  const formats::Primitive& primitive, const Context& context) {
    const std::size_t size = selector.weight.size();
    const auto scale = static_cast<float>(1 / (std::numbers::pi * exit));
    formats::SparseRows rows = formats::make_sparse_rows(selector.cubemap_size, code_bits);
    for_each_block_in_order(
        primitive.position.size(), 64, context,
        [&](Range range) {
            formats::SparseRows block = formats::make_sparse_rows(selector.cubemap_size, code_bits);
            std::vector<float> rgbx(4 * size), planes(3 * size);
            std::vector<ClusterWeight> weights;
            for (std::size_t v = range.begin; v < range.end; ++v) {
                collect_weights(tree, profile, primitive.position[v], primitive.normal[v], options,
                                weights);
                accumulate(tree, weights, rgbx);
                for (std::size_t k = 0; k < size; ++k) {
                    for (std::size_t band = 0; band < 3; ++band) {
                        planes[band * size + k] = scale * rgbx[4 * k + band];
                    }
                }
                formats::append_row(block, select_coefficients(selector, planes, 3));
            }
            return block;
        },
        [&](Range range, const formats::SparseRows& block) {
            formats::append_rows(rows, block);
            if (context.on_progress) {
                context.on_progress({"multiple", range.end, primitive.position.size()});
            }
        });
    return rows;
}

std::uint32_t count_samples(double area, const MediumProfile& profile, std::uint32_t most) {
    constexpr double kLeast = 2000;
    const double z = profile.smallest;
    const double wanted = z > 0 ? std::ceil(area / (z * z)) : 0.0;
    return static_cast<std::uint32_t>(
        std::clamp(wanted, std::min(kLeast, static_cast<double>(most)), static_cast<double>(most)));
}

}  // namespace opaline::bake
