#pragma once

#include <array>
#include <numbers>

#include "bake/base/context.h"
#include "bake/mie/droplet_optics.h"
#include "bake/mie/forward_peak.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Wavelengths that stand for red, green and blue [m].
inline constexpr std::array<double, 3> kBandWavelengths{650e-9, 550e-9, 450e-9};

/// Where fidelity `paper` ends the forward peak of all droplets: 5 degrees [rad].
inline constexpr double kPaperPeakAngle = 5 * std::numbers::pi / 180;

/// What the droplets of a layer do to light of one band. Absorption counts as none: it is below
/// 1e-5 of the extinction of water and ice in visible light.
struct DropletBand {
    DropletOptics optics;
    PeakSplit split;   ///< one angle for all bands: the layer's own, else the green one's
    double kappa = 0;  ///< extinction [1/m], the peak included
    /// By Mie theory: the same, but with fidelity `paper`, whose kappa is N0 pi r_e^2.
    double mie_kappa = 0;
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
