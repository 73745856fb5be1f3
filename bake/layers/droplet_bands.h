#pragma once

#include <array>

#include "bake/base/context.h"
#include "bake/mie/droplet_optics.h"
#include "bake/mie/forward_peak.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Wavelengths that stand for red, green and blue [m].
inline constexpr std::array<double, 3> kBandWavelengths{650e-9, 550e-9, 450e-9};

/// What the droplets of a layer do to light of one band. Absorption counts as none: it is below
/// 1e-5 of the extinction of water and ice in visible light.
struct DropletBand {
    DropletOptics optics;
    PeakSplit split;   ///< one angle for all bands: the green one's, or the layer's own
    double kappa = 0;  ///< extinction [1/m], the peak included
};
using DropletBands = std::array<DropletBand, 3>;

/// The numbers of a layer's droplets.
DropletDistribution droplets_of(const formats::CloudLayer& layer);

/// Mie theory at the three wavelengths, and where the forward peak ends. The same bits for any
/// number of threads. Errors: `usage`, naming the layer, for what average_droplets refuses;
/// `interrupted`.
formats::Result<DropletBands> scatter_bands(const formats::CloudLayer& layer,
                                            const RadiusSampling& sampling, const Context& context);

}  // namespace opaline::bake
