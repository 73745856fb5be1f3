#pragma once

#include <cstdint>
#include <string>

#include "bake/base/context.h"
#include "bake/effects/layers/layer_tables.h"
#include "formats/opal/clouds.h"

namespace opaline::bake {

/// How far a layer's tables err, as a renderer reads them.
struct LayerErrorReport {
    /// Of both parts below: their root of squares, because they are independent.
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of it: depths, lights and views were drawn at random
    /// RMS of the error of radiance over RMS of radiance, over views and azimuths of one depth,
    /// light, side and band; then RMS over these. All light that was scattered by the rest.
    double tables = 0;
    double worst = 0;  ///< of these, the largest
    /// The same of light scattered once, by what the phase functions of the even and of the odd
    /// radii differ. Light scattered more often averages it over directions.
    double droplets = 0;
    double phase_rms = 0;  ///< relative, of phase functions over their rows, by the same halves
    double flux = 0;       ///< largest error of T_ms, T_1 and R_1 [share of the light]
    std::uint32_t radiances_checked = 0;
    std::string reference;  ///< in words
};

/// Compares the tables of a layer with the solver at random: optical depths of thicknesses up to
/// the largest, light up to 80 degrees from the normal, views down to 6 degrees above the horizon.
/// With fidelity `paper` that is the error of the printed forms, of kappa too.
/// Less than a tenth of the bake's time. `droplets`: what the tables were made from.
/// Reports what it has so far once the context is cancelled.
LayerErrorReport check_layer(const formats::CloudsView& clouds, const formats::LayerRecord& record,
                             const DropletBands& droplets, std::uint64_t seed,
                             const Context& context);

/// Multiplications of a check of all bands, in the unit of count_radiance_products.
double check_products();

}  // namespace opaline::bake
