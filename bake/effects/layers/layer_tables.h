#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/layers/layer_knobs.h"
#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/slab_medium.h"
#include "formats/opal/clouds.h"
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

/// The medium without the forward peak, with moments enough for `streams`.
SlabMedium rest_medium(const PeakSplit& split, int streams);

/// Angles [rad] of a row of the glow's table, and the events u of row `row` of `events`.
std::vector<double> glow_angles(const PeakSplit& split, unsigned angles);
double glow_events(unsigned row, unsigned events);

/// Light of the peak alone as the file holds it (formats/opal/clouds.h, LayerTables::glow), without
/// values below 0. Empty where there is no peak.
std::vector<float> tabulate_glow(const PeakSplit& split, unsigned angles, unsigned events);

/// What the tables of a band hold.
struct BandContent {
    bool often = true;   ///< radiance of light that was scattered twice or more
    bool paper = false;  ///< printed forms (paper_tables.h) instead of the solver's results
};

/// All tables of one band in the order of the file. Parallel inside, the same bits for any number
/// of threads; incomplete once the context is cancelled.
std::vector<float> make_band_tables(const DropletBand& band, const LayerTableSizes& sizes,
                                    const BandContent& content, const Context& context);

/// The tables of one band of a file as the rooms that made them read them.
struct StoredTables {
    formats::LayerBand band;
    double peak_angle = 0;
    PhaseTexture phase;
    SlabTable flux;          ///< without orders 2, which no file holds
    RadianceTable radiance;  ///< size.depths 0 where it is left out
};
StoredTables read_tables(const formats::CloudsView& clouds, const formats::LayerRecord& record,
                         std::size_t band);

/// Radiance of light that the rest scattered once or more, over that of a beam of irradiance 1 on a
/// plane facing it [1/sr]; arguments as eval_radiance_table.
double eval_scattered(const StoredTables& tables, double depth, double light, double view,
                      double azimuth, bool transmitted);

/// Angle [rad] between the directions that light and view ray propagate in, in [0, pi].
double scattering_angle(double light, double view, double azimuth, bool transmitted);

}  // namespace opaline::bake
