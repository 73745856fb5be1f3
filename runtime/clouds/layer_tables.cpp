#include "runtime/clouds/layer_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "runtime/clouds/slab_source.h"

namespace opaline::runtime {
namespace {

using formats::LayerRecord;
using formats::LayerTables;
using formats::Rgb;

float mix(float a, float b, float share) {
    return a + share * (b - a);
}

float at_place(std::span<const float> values, const TablePlace& place) {
    return mix(values[place.first], values[place.first + 1], place.share);
}

// Bilinear in a table of `columns` a row.
float at_places(std::span<const float> values, std::size_t columns, const TablePlace& row,
                const TablePlace& column) {
    return mix(at_place(values.subspan(row.first * columns), column),
               at_place(values.subspan((row.first + 1) * columns), column), row.share);
}

// The inverse of s^2 (3 - 2 s).
float inverse_smoothstep(double value) {
    return static_cast<float>(0.5 - std::sin(std::asin(1 - 2 * std::clamp(value, 0.0, 1.0)) / 3));
}

TablePlace place_cosine(float cosine, std::size_t count) {
    return place_on_axis(inverse_smoothstep(static_cast<double>(cosine)), count);
}

// Sum of the modes' values times cos(m phi), by Chebyshev's recurrence.
Rgb sum_modes(const SunTable& table, const std::array<TablePlace, 3>& row, const TablePlace& view,
              float cos_azimuth, bool transmitted) {
    const std::size_t layer = table.depths * table.cosines;
    const std::span<const Rgb> side =
        std::span(table.value).subspan(transmitted ? table.modes * layer : 0, table.modes * layer);
    const float x = std::clamp(cos_azimuth, -1.0f, 1.0f);
    float before = x, now = 1;  // cos(-phi), cos(0)
    Rgb sum;
    for (std::size_t m = 0; m < table.modes; ++m) {
        const auto at = [&](std::size_t band, float Rgb::*channel) {
            const Rgb* near = &side[m * layer + row[band].first * table.cosines + view.first];
            const Rgb* far = near + table.cosines;
            return now * mix(mix(near[0].*channel, near[1].*channel, view.share),
                             mix(far[0].*channel, far[1].*channel, view.share), row[band].share);
        };
        sum = sum + Rgb{at(0, &Rgb::r), at(1, &Rgb::g), at(2, &Rgb::b)};
        const float next = 2 * x * now - before;
        before = now;
        now = next;
    }
    return sum;
}

}  // namespace

TablePlace place_on_axis(float fraction, std::size_t count) {
    const float last = static_cast<float>(count - 1);
    const float at = fraction > 0 ? std::min(fraction, 1.0f) * last : 0.0f;
    const std::size_t first = std::min(static_cast<std::size_t>(at), count - 2);
    return {first, at - static_cast<float>(first)};
}

TablePlace place_depth(float depth, std::size_t count) {
    return place_on_axis(1 - 1 / (1 + depth), count);
}

float phase_coordinate(float angle) {
    return inverse_smoothstep(static_cast<double>(angle) / std::numbers::pi);
}

float peak_mean_square(const LayerTables& tables, const LayerRecord& record) {
    constexpr int kSteps = 256;
    const double end = static_cast<double>(record.peak_angle), step = end / kSteps;
    double weights = 0, sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = (i + 0.5) * step;
        const TablePlace place =
            place_on_axis(phase_coordinate(static_cast<float>(angle)), tables.log_phase.size());
        const double weight =
            std::sin(angle) * std::exp(static_cast<double>(at_place(tables.log_phase, place)));
        weights += weight;
        sum += weight * angle * angle;
    }
    return weights > 0 ? static_cast<float>(sum / weights) : 0.0f;
}

float rest_phase(const LayerTables& tables, const LayerRecord& record, std::size_t band,
                 float angle, float coordinate, float events, float mean_square) {
    const float straight = std::exp(-events);
    const float sigma = std::sqrt(std::max(1.0f, events) * mean_square / 2);
    const float beyond = angle - record.peak_angle;
    float share = beyond >= 0 ? straight : 0.0f;
    share += (1 - straight) *
             (sigma > 0 ? 0.5f * std::erfc(-beyond / (std::numbers::sqrt2_v<float> * sigma))
                        : (beyond >= 0 ? 1.0f : 0.0f));
    if (share <= 0) return 0;
    const TablePlace place = place_on_axis(coordinate, tables.log_phase.size());
    return share * std::exp(at_place(tables.log_phase, place)) /
           (1 - record.band[band].peak_weight);
}

float forward_glow(const LayerTables& tables, const LayerRecord& record, float angle,
                   float events) {
    if (tables.glow.empty() || !(angle < 4 * record.peak_angle) || events > 12) return 0;
    const TablePlace column =
        place_on_axis(std::sqrt(angle / (4 * record.peak_angle)), record.glow_angles);
    const TablePlace row = place_on_axis(std::sqrt(events / 12), record.glow_events);
    return std::max(0.0f, at_places(tables.glow, record.glow_angles, row, column));
}

FluxShares flux_shares(const LayerTables& tables, const LayerRecord& record, float depth,
                       float cosine) {
    const TablePlace row = place_depth(depth, record.flux_depths);
    const TablePlace column = place_on_axis(std::sqrt(cosine), record.flux_cosines);
    const auto read = [&](std::span<const float> values) {
        return std::clamp(at_places(values, record.flux_cosines, row, column), 0.0f, 1.0f);
    };
    FluxShares shares;
    shares.straight = std::exp(-depth / cosine);
    // Interpolated tables may be below the exponential, which is exact.
    const float scattered = taken_share(depth / cosine);
    shares.across = std::clamp(read(tables.t_ms) - shares.straight, 0.0f, scattered);
    shares.reflected = scattered - shares.across;
    shares.once = std::min(read(tables.t1), shares.across);
    return shares;
}

float mean_transmittance(const LayerTables& tables, float depth) {
    return std::clamp(at_place(tables.mean_t, place_depth(depth, tables.mean_t.size())), 0.0f,
                      1.0f);
}

SunTable make_sun_table(const std::array<LayerTables, 3>& tables, const LayerRecord& record,
                        float cosine) {
    SunTable sun;
    if (record.radiance_depths == 0) return sun;
    sun.modes = record.radiance_modes;
    sun.depths = record.radiance_depths;
    sun.cosines = record.radiance_cosines;
    sun.value.reserve(2 * sun.modes * sun.depths * sun.cosines);
    const TablePlace light = place_cosine(cosine, sun.cosines);
    for (const auto side : {&LayerTables::reflected, &LayerTables::transmitted}) {
        for (std::size_t m = 0; m < sun.modes; ++m) {
            for (std::size_t depth = 0; depth < sun.depths; ++depth) {
                for (std::size_t view = 0; view < sun.cosines; ++view) {
                    const std::size_t at =
                        ((depth * sun.modes + m) * sun.cosines + view) * sun.cosines;
                    const auto read = [&](std::size_t band) {
                        return at_place((tables[band].*side).subspan(at, sun.cosines), light);
                    };
                    sun.value.push_back({read(0), read(1), read(2)});
                }
            }
        }
    }
    return sun;
}

Rgb multiple_source(const SunTable& table, const std::array<float, 3>& depth, float light,
                    float view, float cos_azimuth, bool transmitted) {
    if (table.modes == 0) return {};
    std::array<TablePlace, 3> row;
    for (std::size_t b = 0; b < 3; ++b) {
        row[b] = place_depth(depth[b], table.depths);
    }
    const Rgb sum =
        sum_modes(table, row, place_cosine(view, table.cosines), cos_azimuth, transmitted);
    // mu_l / (mu_l + mu_v) (1 - exp(-X_l - X_v)) / (1 - exp(-X_v)) is that of single scattering.
    const auto scaled = [&](float value, float d) {
        return std::max(0.0f, value) * reflected_source(d, light, view) *
               std::numbers::inv_pi_v<float>;
    };
    return {scaled(sum.r, depth[0]), scaled(sum.g, depth[1]), scaled(sum.b, depth[2])};
}

}  // namespace opaline::runtime
