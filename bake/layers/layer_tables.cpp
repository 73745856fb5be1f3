#include "bake/layers/layer_tables.h"

#include <algorithm>
#include <cstddef>

#include "bake/layers/paper_tables.h"
#include "bake/mie/phase_texture.h"

namespace opaline::bake {
namespace {

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

std::vector<double> glow_angles(const PeakSplit& split, unsigned angles) {
    constexpr double kMost = 4;  // angles of the peak
    std::vector<double> angle;
    for (unsigned i = 0; i < angles; ++i) {
        const double s = i / (angles - 1.0);
        angle.push_back(kMost * split.angle * s * s);
    }
    return angle;
}

double glow_events(unsigned row, unsigned events) {
    constexpr double kMost = 12;
    const double q = row / (events - 1.0);
    return kMost * q * q;
}

std::vector<float> tabulate_glow(const PeakSplit& split, unsigned angles, unsigned events) {
    std::vector<float> glow;
    if (!(split.angle > 0)) {
        return glow;
    }
    const std::vector<double> moments = table_moments(split.peak, kGlowMoments);
    const std::vector<double> angle = glow_angles(split, angles);
    for (unsigned j = 0; j < events; ++j) {
        for (const double value : forward_glow(split, moments, glow_events(j, events), angle)) {
            // The series leaves noise around 0 where there is next to no light.
            glow.push_back(static_cast<float>(std::max(0.0, value)));
        }
    }
    return glow;
}

std::vector<float> make_band_tables(const DropletBand& band, const LayerTableSizes& sizes,
                                    const BandContent& content, const Context& context) {
    std::vector<float> values = make_phase_texture(band.optics.phase, sizes.phase_angles).log_value;
    append((content.paper ? tabulate_paper_glow : tabulate_glow)(band.split, sizes.glow_angles,
                                                                 sizes.glow_events),
           values);
    const SlabTable flux = content.paper
                               ? make_paper_fluxes(band.split.weight, sizes.flux)
                               : make_slab_table(rest_medium(band.split, sizes.flux_streams),
                                                 sizes.flux, sizes.flux_streams, context);
    for (const std::vector<float>* part : {&flux.t1, &flux.t_ms, &flux.r1, &flux.mean_t}) {
        append(*part, values);
    }
    if (content.often && !context.cancelled()) {
        const RadianceTable radiance =
            content.paper ? make_paper_radiance(band.split, sizes.radiance)
                          : make_radiance_table(rest_medium(band.split, sizes.radiance_streams),
                                                sizes.radiance, sizes.radiance_streams, context);
        append_modes(radiance.reflected, sizes.radiance, values);
        append_modes(radiance.transmitted, sizes.radiance, values);
    }
    return values;
}

}  // namespace opaline::bake
