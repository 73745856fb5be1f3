#include "bake/slab/slab_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/slab/once_fluxes.h"
#include "bake/slab/solve_slab.h"
#include "bake/slab/table_place.h"

namespace opaline::bake {
SlabTable make_slab_table(const SlabMedium& medium, SlabTableSize size, int streams,
                          const Context& context) {
    assert(size.depths >= 2 && size.cosines >= 2);
    SlabMedium conservative = medium;
    conservative.albedo = 1;
    SlabRequest all_rows{0, 0, {}, streams, size.has_twice ? 3u : 0u};
    for (std::size_t j = 0; j < size.cosines; ++j) {
        const double root = static_cast<double>(j) / static_cast<double>(size.cosines - 1);
        all_rows.cosine.push_back(std::max(kMinSlabCosine, root * root));
    }
    std::vector<double> depths;
    for (std::size_t i = 0; i < size.depths; ++i) {
        depths.push_back(depth_of_node(i, size.depths, kMaxSlabDepth));
    }
    const std::vector<OnceFluxes> once =
        scatter_once(conservative, depths, all_rows.cosine, streams);
    SlabTable table;
    table.size = size;
    for_each_block_in_order(
        size.depths, 1, context,
        [&](Range row) {
            SlabRequest request = all_rows;
            request.optical_depth = depths[row.begin];
            return solve_slab(conservative, request).front();
        },
        [&](Range row, const SlabSolution& slab) {
            // Orders are good to 1e-10: in row 0, and where they are nearly none, that is more
            // than all.
            const auto order_share = [&](double share) {
                return row.begin > 0 ? static_cast<float>(std::max(0.0, share)) : 0.0f;
            };
            for (std::size_t j = 0; j < size.cosines; ++j) {
                table.t1.push_back(order_share(once[row.begin].transmitted[j]));
                table.r1.push_back(order_share(once[row.begin].reflected[j]));
                table.t2.push_back(size.has_twice ? order_share(slab.order[2].transmittance[j])
                                                  : 0.0f);
                table.r2.push_back(size.has_twice ? order_share(slab.order[2].reflectance[j])
                                                  : 0.0f);
                table.t_ms.push_back(static_cast<float>(slab.total.transmittance[j]));
            }
            table.mean_t.push_back(static_cast<float>(slab.total.mean_transmittance));
        });
    return table;
}

OrderShares eval_slab_table(const SlabTable& table, double depth, double cosine) {
    const TablePlace row = place_depth(depth, table.size.depths);
    const TablePlace column = place_at(std::sqrt(std::clamp(cosine, 0.0, 1.0)), table.size.cosines);
    const auto at = [&](const std::vector<float>& values) {
        double sum = 0;
        for (const std::size_t below : {0u, 1u}) {
            for (const std::size_t beside : {0u, 1u}) {
                sum +=
                    (below == 0 ? 1 - row.share : row.share) *
                    (beside == 0 ? 1 - column.share : column.share) *
                    static_cast<double>(
                        values[(row.first + below) * table.size.cosines + column.first + beside]);
            }
        }
        return sum;
    };
    OrderShares shares;
    shares.transmitted[1] = at(table.t1);
    shares.transmitted[2] = at(table.t2);
    shares.reflected[1] = at(table.r1);
    shares.reflected[2] = at(table.r2);
    const double straight = depth > 0 ? std::exp(-depth / std::max(cosine, kMinSlabCosine)) : 1.0;
    return complete_shares(shares, straight, at(table.t_ms));
}

double eval_mean_transmittance(const SlabTable& table, double depth) {
    const TablePlace row = place_depth(depth, table.size.depths);
    return (1 - row.share) * static_cast<double>(table.mean_t[row.first]) +
           row.share * static_cast<double>(table.mean_t[row.first + 1]);
}

}  // namespace opaline::bake
