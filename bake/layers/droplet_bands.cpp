#include "bake/layers/droplet_bands.h"

#include <utility>

#include "bake/mie/refractive_index.h"

namespace opaline::bake {

DropletDistribution droplets_of(const formats::CloudLayer& layer) {
    return {layer.droplets, layer.effective_radius, layer.gamma};
}

formats::Result<DropletBands> scatter_bands(const formats::CloudLayer& layer,
                                            const RadiusSampling& sampling,
                                            const Context& context) {
    const DropletDistribution droplets = droplets_of(layer);
    DropletBands bands;
    for (std::size_t band = 0; band < bands.size(); ++band) {
        const auto index =
            refractive_index(layer.ice ? Substance::ice : Substance::water, kBandWavelengths[band]);
        auto optics = average_droplets(droplets, kBandWavelengths[band], *index, sampling, context);
        if (!optics) {
            formats::Error error = std::move(optics).error();
            if (error.kind != formats::ErrorKind::interrupted) {
                error.diagnostics.front().where =
                    layer.name + " > " + error.diagnostics.front().where;
            }
            return error;
        }
        bands[band].optics = std::move(*optics);
        bands[band].mie_kappa = extinction(droplets, bands[band].optics);
        bands[band].kappa = layer.paper ? printed_extinction(droplets) : bands[band].mie_kappa;
    }
    const double angle = layer.peak_angle.value_or(
        layer.paper ? kPaperPeakAngle : find_peak_angle(bands[1].optics.phase));
    for (DropletBand& band : bands) {
        band.split = split_peak(band.optics.phase, angle);
    }
    return bands;
}

}  // namespace opaline::bake
