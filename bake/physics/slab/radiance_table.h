#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bake/base/context.h"
#include "bake/physics/slab/slab_medium.h"

namespace opaline::bake {

/// Between two of the nodes of an axis: the first, and the share of the second.
struct TablePlace {
    std::size_t first = 0;
    double share = 0;
};

/// `fraction` of an axis of `count` >= 2 even nodes; past an end, that end.
inline TablePlace place_at(double fraction, std::size_t count) {
    const double at = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(at), count - 2);
    return {first, at - static_cast<double>(first)};
}

/// Even in depth / (1 + depth), so that the last node is an infinite depth.
inline TablePlace place_depth(double depth, std::size_t count) {
    return place_at(1 - 1 / (1 + depth), count);
}
inline double depth_of_node(std::size_t node, std::size_t count, double most) {
    const double left = static_cast<double>(count - 1 - node);
    return left > 0 ? std::min(static_cast<double>(node) / left, most) : most;
}

/// Shares of a beam's flux that leave a slab of albedo 1, by order: index 0, 1 and 2, then 3 for
/// all orders after these.
struct OrderShares {
    double transmitted[4] = {1, 0, 0, 0};
    double reflected[4] = {0, 0, 0, 0};
};

/// Fills in order 0 and the orders from 3 on, so that all shares add up to 1. `straight` = T_0 and
/// `transmittance` = T_0 + T_1 + ..., both in [0, 1]. Orders 1 and 2 of `shares` may come from a
/// model that knows nothing of the others: where they exceed what is left to them, they shrink to
/// it.
OrderShares complete_shares(OrderShares shares, double straight, double transmittance);

/// Number of rows and columns of a SlabTable, 2 or more each.
struct SlabTableSize {
    std::size_t depths = 64, cosines = 32;
    bool has_twice = true;  ///< else t2 and r2 are 0, and the table takes a tenth of the time
};

/// What a slab of albedo 1 does with a beam, tabulated for a renderer. Row i is the optical depth
/// tau with tau / (1 + tau) = i / (depths - 1), and infinity in the last; column j the cosine with
/// sqrt(cosine) = j / (cosines - 1). T_0 = exp(-tau / cosine) is not in it: it needs no table.
struct SlabTable {
    SlabTableSize size;
    std::vector<float> t1, t2, t_ms, r1, r2;  ///< [i * cosines + j]; t_ms: all that is transmitted
    std::vector<float> mean_t;                ///< [i]: of even light over the hemisphere
};

/// By adding and doubling with as many `streams` (solve_slab); the albedo of `medium` counts as 1.
/// Row 0 is exactly T_ms = 1 and no scattering. About a second of one thread for 64 x 32 and 16
/// streams; the same bits for any number of threads. Lacks rows once the context is cancelled.
SlabTable make_slab_table(const SlabMedium& medium, SlabTableSize size = {}, int streams = 16,
                          const Context& context = {});

/// All shares, of sum 1, by linear interpolation along both axes; depth >= 0, cosine in [0, 1].
OrderShares eval_slab_table(const SlabTable& table, double depth, double cosine);

/// T of even light by linear interpolation, depth >= 0; R is 1 less that.
double eval_mean_transmittance(const SlabTable& table, double depth);

/// Number of nodes along the axes of a RadianceTable, 2 or more each, and of azimuth modes, 1 or
/// more. The cosines' axis serves light and view.
struct RadianceTableSize {
    std::size_t depths = 32, cosines = 24, modes = 8;
};

/// Radiance of all light that a slab of albedo 1 scattered twice or more, tabulated for a renderer:
/// what is left of it, once single scattering is exact, is smooth. Depths as in SlabTable. Cosine j
/// is s^2 (3 - 2 s) at s = j / (cosines - 1), dense at both ends, but not below kLeastTableCosine.
/// A value is mode m of the reflection factor (SlabRadiance) over (1 - exp(-X_l - X_v)) / (mu_l +
/// mu_v), the shape of it near the horizon; it is symmetric in light and view.
struct RadianceTable {
    RadianceTableSize size;
    /// [((depth * modes + m) * cosines + view) * cosines + light]
    std::vector<float> reflected, transmitted;
};
inline constexpr double kLeastTableCosine = 1e-3;

/// By adding and doubling with as many `streams`; the albedo of `medium` counts as 1. A few
/// seconds of one thread; the same bits for any number of threads. Lacks rows once the context is
/// cancelled. Error of droplets of 7 um without their forward peak, eight modes: 1 % of the RMS
/// radiance of a layer, for light up to 80 degrees from the normal (tests/bench/RESULTS.md).
RadianceTable make_radiance_table(const SlabMedium& medium, RadianceTableSize size = {},
                                  int streams = 24, const Context& context = {});

/// Radiance of light scattered twice or more over that of a beam of irradiance 1 on a plane facing
/// it [1/sr], by linear interpolation: depth >= 0, cosines of light and view in [0, 1], `azimuth`
/// [rad] between the horizontal directions that both propagate in. `transmitted`: on the side away
/// from the light. May be below 0 by the error of the modes.
double eval_radiance_table(const RadianceTable& table, double depth, double light, double view,
                           double azimuth, bool transmitted);

}  // namespace opaline::bake
