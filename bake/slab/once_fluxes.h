#pragma once

#include <span>
#include <vector>

#include "bake/slab/slab_medium.h"

namespace opaline::bake {

/// Shares of a beam's flux that leave a slab after exactly one scattering, by cosine of incidence.
struct OnceFluxes {
    std::vector<double> reflected, transmitted;
};

/// In closed form, integrated over views by the rule of as many `streams`: what solve_slab gives as
/// order 1, peak of the phase function included, at a hundredth of its time. One element for each
/// of `depths`, >= 0. `cosines` in [kMinSlabCosine, 1].
std::vector<OnceFluxes> scatter_once(const SlabMedium& medium, std::span<const double> depths,
                                     std::span<const double> cosines, int streams);

}  // namespace opaline::bake
