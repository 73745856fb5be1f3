#pragma once

#include <cstddef>
#include <vector>

#include "bake/base/context.h"
#include "bake/slab/order_shares.h"
#include "bake/slab/slab_medium.h"

namespace opaline::bake {

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

}  // namespace opaline::bake
