#include "bake/layers/describe_layers.h"

#include <array>

#include "bake/calibration/bench/calibration_bench.h"
#include "bake/calibration/bench/stopwatch.h"
#include "bake/layers/droplet_bands.h"
#include "bake/layers/layer_knobs.h"
#include "bake/layers/layer_tables.h"
#include "bake/layers/layer_work.h"
#include "bake/layers/plan_layers.h"
#include "bake/mie/refractive_index.h"

namespace opaline::bake {
namespace {

constexpr std::array<const KnobSpec*, 2> kCloudKnobs{&kCloudStep, &kCloudNodes};

/// Seconds of the units of work of layers (layer_work.h): 0.1 s in all.
void calibrate_layers(const CalibrationBench& bench, Rates& rates) {
    if (!bench.is_many) {
        return;
    }
    const DropletDistribution droplets{3e8, 4e-6, 2};
    constexpr double kWavelength = 550e-9;
    const RadiusSampling sampling{1, 64, 64};
    const Stopwatch spheres;
    const auto optics =
        average_droplets(droplets, kWavelength, *refractive_index(Substance::water, kWavelength),
                         sampling, one_thread());
    rates.series_term = spheres.seconds() / count_series_terms(droplets, kWavelength, sampling);
    constexpr int kStreams = 16;
    const SlabMedium medium = rest_medium(split_peak(optics->phase, 0.1), kStreams);
    const SlabTableSize flux{16, 24, false};
    const Stopwatch fluxes;
    static_cast<void>(make_slab_table(medium, flux, kStreams, one_thread()));
    rates.flux_product = fluxes.seconds() / count_flux_products(flux, kStreams);
    const RadianceTableSize radiance{8, 16, 4};
    const Stopwatch radiances;
    static_cast<void>(make_radiance_table(medium, radiance, kStreams, one_thread()));
    rates.radiance_product = radiances.seconds() / count_radiance_products(radiance, kStreams);
}

}  // namespace

EffectDescriptor describe_cloud(Effect id) {
    return {.id = id,
            .name = kCloud,
            .help = "light scattered by the droplets of cloud layers",
            .knobs = kCloudKnobs,
            .concerns_layers = true,
            .calibrate = calibrate_layers};
}

EffectDescriptor describe_radiosity(Effect id) {
    return {.id = id,
            .name = kRadiosity,
            .help = "light between cloud layers and the ground",
            .concerns_layers = true};
}

}  // namespace opaline::bake
