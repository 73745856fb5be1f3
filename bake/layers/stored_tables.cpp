#include "bake/layers/stored_tables.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "bake/slab/low_orders.h"

namespace opaline::bake {
namespace {

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
