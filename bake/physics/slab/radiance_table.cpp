#include "bake/physics/slab/radiance_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/physics/slab/solve_radiance.h"
#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

/// What values are divided by: single scattering looks so, and so do later orders at the horizon.
double horizon_shape(double depth, double light, double view) {
    return -std::expm1(-depth / light - depth / view) / (light + view);
}

TablePlace place_cosine(double cosine, std::size_t count) {
    // The inverse of s^2 (3 - 2 s).
    return place_at(0.5 - std::sin(std::asin(1 - 2 * cosine) / 3), count);
}

/// Shrinks two shares to a sum of `most` at most; returns what they leave of it.
double leave_rest(double& first, double& second, double most) {
    const double sum = first + second;
    if (sum <= most) return most - sum;
    const double scale = std::max(most, 0.0) / sum;
    first *= scale;
    second *= scale;
    return 0;
}

}  // namespace

RadianceTable make_radiance_table(const SlabMedium& medium, RadianceTableSize size, int streams,
                                  const Context& context) {
    assert(size.depths >= 2 && size.cosines >= 2 && size.modes >= 1);
    SlabMedium conservative = medium;
    conservative.albedo = 1;
    SlabRadianceRequest all_rows;
    all_rows.streams = streams;
    all_rows.modes = static_cast<unsigned>(size.modes);
    all_rows.first_order = 2;
    for (std::size_t j = 0; j < size.cosines; ++j) {
        const double s = static_cast<double>(j) / static_cast<double>(size.cosines - 1);
        all_rows.view.push_back(std::max(kLeastTableCosine, s * s * (3 - 2 * s)));
    }
    all_rows.lights = all_rows.view;
    RadianceTable table;
    table.size = size;
    const std::size_t layer = size.modes * size.cosines * size.cosines;
    // Row 0 is the limit of thin layers: twice or more is nothing to once.
    table.reflected.assign(layer, 0);
    table.transmitted.assign(layer, 0);
    for_each_block_in_order(
        size.depths - 1, 1, context,
        [&](Range row) {
            SlabRadianceRequest request = all_rows;
            request.optical_depth = depth_of_node(row.begin + 1, size.depths, kMaxSlabDepth);
            return solve_slab_radiance(conservative, request).front();
        },
        [&](Range, const SlabRadiance& slab) {
            for (std::size_t at = 0; at < layer; ++at) {
                const double light = all_rows.lights[at % size.cosines];
                const double view = all_rows.view[at / size.cosines % size.cosines];
                const double shape = horizon_shape(slab.optical_depth, light, view);
                table.reflected.push_back(static_cast<float>(slab.reflected[at] / shape));
                table.transmitted.push_back(static_cast<float>(slab.transmitted[at] / shape));
            }
        });
    return table;
}

double eval_radiance_table(const RadianceTable& table, double depth, double light, double view,
                           double azimuth, bool transmitted) {
    const RadianceTableSize& size = table.size;
    const std::vector<float>& values = transmitted ? table.transmitted : table.reflected;
    const double mu_l = std::clamp(light, kLeastTableCosine, 1.0);
    const double mu_v = std::clamp(view, kLeastTableCosine, 1.0);
    const TablePlace row = place_depth(depth, size.depths);
    const TablePlace at_light = place_cosine(mu_l, size.cosines);
    const TablePlace at_view = place_cosine(mu_v, size.cosines);
    double sum = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t i = corner & 1u, v = corner >> 1u & 1u, l = corner >> 2u;
        const double weight = (i == 0 ? 1 - row.share : row.share) *
                              (v == 0 ? 1 - at_view.share : at_view.share) *
                              (l == 0 ? 1 - at_light.share : at_light.share);
        for (std::size_t m = 0; m < size.modes; ++m) {
            const std::size_t at =
                (((row.first + i) * size.modes + m) * size.cosines + at_view.first + v) *
                    size.cosines +
                at_light.first + l;
            sum += weight * (m == 0 ? 1 : 2) * std::cos(static_cast<double>(m) * azimuth) *
                   static_cast<double>(values[at]);
        }
    }
    return mu_l / std::numbers::pi * horizon_shape(depth, mu_l, mu_v) * sum;
}

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

OrderShares complete_shares(OrderShares shares, double straight, double transmittance) {
    const double all = std::clamp(transmittance, straight, 1.0);
    shares.transmitted[0] = straight;
    shares.transmitted[3] =
        leave_rest(shares.transmitted[1], shares.transmitted[2], all - straight);
    shares.reflected[3] = leave_rest(shares.reflected[1], shares.reflected[2], 1 - all);
    return shares;
}

}  // namespace opaline::bake
