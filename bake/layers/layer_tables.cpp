#include "bake/layers/layer_tables.h"

#include <algorithm>
#include <cstddef>

#include "bake/mie/phase_texture.h"

namespace opaline::bake {
namespace {

constexpr double kMostGlowEvents = 12, kMostGlowAngle = 4;  // the latter in angles of the peak

void append(const std::vector<float>& from, std::vector<float>& to) {
    to.insert(to.end(), from.begin(), from.end());
}

// The file's modes carry the factor 2 that the sum over cos(m phi) has for m > 0.
void append_modes(const std::vector<float>& from, const RadianceTableSize& size,
                  std::vector<float>& to) {
    const std::size_t mode = size.cosines * size.cosines;
    for (std::size_t at = 0; at < from.size(); ++at) {
        to.push_back(at / mode % size.modes == 0 ? from[at] : 2 * from[at]);
    }
}

}  // namespace

SlabMedium rest_medium(const PeakSplit& split, int streams) {
    return {table_moments(split.rest, 2 * static_cast<unsigned>(streams) + 1), 1};
}

std::vector<float> tabulate_glow(const PeakSplit& split, unsigned angles, unsigned events) {
    std::vector<float> glow;
    if (!(split.angle > 0)) {
        return glow;
    }
    const std::vector<double> moments = table_moments(split.peak, kGlowMoments);
    std::vector<double> angle;
    for (unsigned i = 0; i < angles; ++i) {
        const double s = i / (angles - 1.0);
        angle.push_back(kMostGlowAngle * split.angle * s * s);
    }
    for (unsigned j = 0; j < events; ++j) {
        const double q = j / (events - 1.0);
        for (const double value : forward_glow(split, moments, kMostGlowEvents * q * q, angle)) {
            // The series leaves noise around 0 where there is next to no light.
            glow.push_back(static_cast<float>(std::max(0.0, value)));
        }
    }
    return glow;
}

std::vector<float> make_band_tables(const DropletBand& band, const LayerTableSizes& sizes,
                                    bool often, const Context& context) {
    std::vector<float> values = make_phase_texture(band.optics.phase, sizes.phase_angles).log_value;
    append(tabulate_glow(band.split, sizes.glow_angles, sizes.glow_events), values);
    const SlabTable flux = make_slab_table(rest_medium(band.split, sizes.flux_streams), sizes.flux,
                                           sizes.flux_streams, context);
    for (const std::vector<float>* part : {&flux.t1, &flux.t_ms, &flux.r1, &flux.mean_t}) {
        append(*part, values);
    }
    if (often && !context.cancelled()) {
        const RadianceTable radiance =
            make_radiance_table(rest_medium(band.split, sizes.radiance_streams), sizes.radiance,
                                sizes.radiance_streams, context);
        append_modes(radiance.reflected, sizes.radiance, values);
        append_modes(radiance.transmitted, sizes.radiance, values);
    }
    return values;
}

}  // namespace opaline::bake
