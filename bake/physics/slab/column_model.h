#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/slab_medium.h"

namespace opaline::bake {

/// The one-dimensional model of multiple scattering of [Bouthors2006], appendix A: a column that
/// scatters forward or back, and a transmittance with the right limit of thick layers. Lengths are
/// in any one unit: metres in `paper2006`, optical depths of the slab in `fit_column_models`.
struct ColumnModel {
    double length = 1;             ///< L: T of a thick layer falls like L / thickness
    double beta = 1;               ///< of a beam over even light, in a thick layer
    double decay = 1;              ///< c [1/length]
    double extinction = 1;         ///< kappa_c, of the column [1/length]
    double forward = 1, back = 0;  ///< t and r: weights of a scattering
};

/// T_ms = (beta + (1 - beta) exp(-c H)) / (1 + H / L); H >= 0.
double column_transmittance(const ColumnModel& model, double thickness);

/// T_1, T_2, R_1, R_2 of the column, [0] and [3] being 0: in terms of x = kappa_c H >= 0,
///   T_1 = t x e^-x,   T_2 = ((t x)^2 / 2 + (r^2 / 4) (2 x - 1 + e^-2x)) e^-x,
///   R_1 = (r / 2) (1 - e^-2x),   R_2 = (r t / 2) (1 - (1 + 2 x) e^-2x).
/// T_2 as printed has H for -H in an exponent of e.
OrderShares column_orders(const ColumnModel& model, double thickness);

/// All shares, of sum 1 (complete_shares): `straight` = T_0 is that of the slab itself, not of the
/// column.
OrderShares eval_column_model(const ColumnModel& model, double thickness, double straight);

/// Appendix B of [Bouthors2006] as printed, for droplets of effective radius 7 um, 3e8 per m^3, in
/// metres: light at 0, 10, ... 90 degrees. Off by 0.01 of the light at most angles, by 0.1 at 80
/// degrees; round values at 80 and 90 degrees. Parameters are linear in the angle [degrees]
/// between.
ColumnModel paper2006_at(double degrees);

/// kappa [1/m] of the droplets that paper2006 is for, by the paper's N0 pi r_e^2.
inline constexpr double kPaper2006Extinction = 3e8 * std::numbers::pi * 7e-6 * 7e-6;

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
