#pragma once

#include <span>
#include <vector>

#include "bake/slab/column_model.h"
#include "bake/slab/slab_medium.h"

namespace opaline::bake {

/// A fitted model and how far it is from what it was fitted to, in shares of the incident flux.
struct ColumnFit {
    ColumnModel model;                                    ///< lengths in optical depths
    double rms_transmittance = 0, max_transmittance = 0;  ///< of all orders together
    double rms_orders = 0, max_orders = 0;                ///< of T_1, T_2, R_1 and R_2
};

/// The optical depths that models are fitted at: fourteen, from 0.045 to 23.
std::span<const double> column_fit_depths();

/// Fits the model to adding and doubling, for each cosine of incidence, in [0.01, 1], at optical
/// depths in (0, kMaxSlabDepth], at least 3. Thick layers fix the length: L = 1.4209 / (1 - g)
/// [vandeHulst1980]; beta and c come from the transmittance, the rest from the orders 1 and 2.
/// `medium`: its albedo counts as 1; g < 1.
std::vector<ColumnFit> fit_column_models(const SlabMedium& medium, std::span<const double> cosines,
                                         std::span<const double> depths, int streams = 32);

}  // namespace opaline::bake
