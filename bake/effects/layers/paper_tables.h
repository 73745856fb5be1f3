#pragma once

#include <vector>

#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/slab/radiance_table.h"

namespace opaline::bake {

// What [Bouthors2006] prints for a slab, in the form of the tables that the solver fills otherwise:
// fidelity `paper` (README.md, "Fidelity paper"). All values are finite and at least 0.

/// Thickness [m] at which the droplets that appendix B is for have the optical depth `depth` of the
/// medium without the peak, P_f being the peak's weight: for these droplets the thickness itself.
double paper_thickness(double depth, double peak_weight);

/// T_1, R_1, T_ms of appendix A with the parameters of appendix B, linear in the angle of the
/// light. T_2 and R_2 too. Sums of orders may exceed T_ms, as in the paper. `mean_t` is the mean of
/// T_ms over the hemisphere: the paper has the sun's T_ms in its place, which no table can.
SlabTable make_paper_fluxes(double peak_weight, const SlabTableSize& size);

/// Orders of two and more: two as single scattering with the phase function P * P, which grows like
/// the depth and not like its square, and R_3+ / (2 pi mu_v), T_3+ / (2 pi mu_v) with the energies
/// of appendix A, 0 where these are negative. Printed is 4 pi, half of these energies.
RadianceTable make_paper_radiance(const PeakSplit& split, const RadianceTableSize& size);

/// Light of the peak alone as P_F convolved n times with itself, n = kappa H = u / P_f all events
/// on the way, linear between whole numbers; below one event, n P_F. Its integral is 1 from n = 1
/// on, beside the direct light. Layout as tabulate_glow.
std::vector<float> tabulate_paper_glow(const PeakSplit& split, unsigned angles, unsigned events);

}  // namespace opaline::bake
