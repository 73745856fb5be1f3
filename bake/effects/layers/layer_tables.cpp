#include "bake/effects/layers/layer_tables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/layers/paper_tables.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/mie/refractive_index.h"
#include "bake/physics/slab/low_orders.h"

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

std::vector<float> copy_of(std::span<const float> values) {
    return {values.begin(), values.end()};
}

// The file's modes carry the factor 2 of the sum over cos(m phi) for m > 0.
std::vector<float> copy_modes(std::span<const float> values, const RadianceTableSize& size) {
    std::vector<float> modes = copy_of(values);
    const std::size_t mode = size.cosines * size.cosines;
    for (std::size_t at = 0; at < modes.size(); ++at) {
        modes[at] *= at / mode % size.modes == 0 ? 1.0f : 0.5f;
    }
    return modes;
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
    if (!(split.angle > 0)) return glow;
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

StoredTables read_tables(const formats::CloudsView& clouds, const formats::LayerRecord& record,
                         std::size_t band) {
    const formats::LayerTables stored = formats::tables_of(clouds, record, band);
    StoredTables tables;
    tables.band = record.band[band];
    tables.peak_angle = static_cast<double>(record.peak_angle);
    tables.phase.log_value = copy_of(stored.log_phase);
    tables.flux.size = {record.flux_depths, record.flux_cosines};
    tables.flux.t1 = copy_of(stored.t1);
    tables.flux.t_ms = copy_of(stored.t_ms);
    tables.flux.r1 = copy_of(stored.r1);
    tables.flux.t2.assign(stored.t1.size(), 0);
    tables.flux.r2.assign(stored.t1.size(), 0);
    tables.flux.mean_t = copy_of(stored.mean_t);
    tables.radiance.size = {record.radiance_depths, record.radiance_cosines, record.radiance_modes};
    if (!stored.reflected.empty()) {
        tables.radiance.reflected = copy_modes(stored.reflected, tables.radiance.size);
        tables.radiance.transmitted = copy_modes(stored.transmitted, tables.radiance.size);
    }
    return tables;
}

double scattering_angle(double light, double view, double azimuth, bool transmitted) {
    const double sine_l = std::sqrt(1 - light * light), sine_v = std::sqrt(1 - view * view);
    // Both directions, light going down.
    const double x = sine_v * std::cos(azimuth), y = sine_v * std::sin(azimuth);
    const double up = transmitted ? -view : view;
    const double sum = std::hypot(sine_l + x, y, up - light);
    const double difference = std::hypot(sine_l - x, y, up + light);
    return 2 * std::atan2(difference, sum);
}

double eval_scattered(const StoredTables& tables, double depth, double light, double view,
                      double azimuth, bool transmitted) {
    const double angle = scattering_angle(light, view, azimuth, transmitted);
    const double once =
        transmitted ? transmitted_once(depth, light, view) : reflected_once(depth, light, view);
    double radiance = 0;
    if (angle >= tables.peak_angle) {
        radiance += eval_texture(tables.phase, angle) /
                    (1 - static_cast<double>(tables.band.peak_weight)) * once;
    }
    if (!tables.radiance.reflected.empty()) {
        radiance += eval_radiance_table(tables.radiance, depth, light, view, azimuth, transmitted);
    }
    return radiance;
}

}  // namespace opaline::bake
