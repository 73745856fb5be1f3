#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/physics/mie/angular_table.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/slab/radiance_table.h"
#include "formats/opal/clouds.h"

namespace opaline::test {

/// A cloud layer as a file holds it, made without the baker's own room for layers: small tables,
/// for tests of what reads them. Programs link opaline_mie and opaline_slab.

/// The droplets of a test: a forward peak, a broad lobe and a bow, as sums of Henyey-Greenstein's
/// function and a Gaussian; quicker than Mie's series, and as steep. All bands are alike but for
/// the extinction.
struct TestDroplets {
    double peak_angle = 0.08;                       ///< theta_f [rad]; 0: no peak
    std::array<double, 3> kappa{0.05, 0.06, 0.07};  ///< [1/m]
    bool bow = true;
};

inline bake::AngularTable test_phase(const TestDroplets& droplets) {
    bake::AngularTable table;
    const auto lobe = [](double g, double cosine) {
        return (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5) / (4 * 3.14159265358979);
    };
    for (int i = 0; i <= 1200; ++i) {
        const double angle = bake::texture_angle(i / 1200.0), cosine = std::cos(angle);
        double value = (droplets.peak_angle > 0 ? 0.4 * lobe(0.99, cosine) : 0.0) +
                       0.55 * lobe(0.75, cosine) + 0.05 * lobe(-0.3, cosine);
        if (droplets.bow) {
            value += 0.05 * std::exp(-std::pow((angle - 2.45) / 0.06, 2)) +
                     0.08 * std::exp(-std::pow((angle - 3.14159265) / 0.03, 2));
        }
        table.angle.push_back(angle);
        table.value.push_back(value);
    }
    bake::scale_table(table, 1 / bake::integrate_table(table));
    return table;
}

/// Thickness [m] at the centre of cell (column, row), >= 0.
using TestThickness = std::function<double(std::uint32_t column, std::uint32_t row)>;

struct TestLayer {
    formats::LayerRecord record;  ///< where, how large; counts and what follows from others is set
    TestDroplets droplets;
    bake::SlabTableSize flux{32, 16};
    bake::RadianceTableSize radiance{12, 10, 6};  ///< depths 0: none
    std::uint32_t phase_angles = 256, glow_angles = 48, glow_events = 16;
};

/// Even, 100 m thick, endless; ground of albedo 0.2.
inline TestLayer even_test_layer() {
    TestLayer layer;
    layer.record.base = 1000;
    layer.record.size = {8000, 8000};
    layer.record.highest = 100;
    layer.record.flags = formats::LayerRecord::kRepeat | formats::LayerRecord::kRadiosity;
    layer.record.columns = layer.record.rows = 4;
    layer.record.ground_columns = layer.record.ground_rows = 1;
    return layer;
}

// One up to 300 m thick with haze, for heights of the caller's, over a ground of 7 x 6 squares.
inline TestLayer uneven_test_layer(std::uint32_t columns, std::uint32_t rows) {
    TestLayer layer = even_test_layer();
    layer.flux = {16, 10};
    layer.radiance = {8, 8, 4};
    layer.record.columns = columns;
    layer.record.rows = rows;
    layer.record.highest = 300;
    layer.record.center = {500, -300};
    layer.record.ground_columns = 7;
    layer.record.ground_rows = 6;
    layer.record.haze = 2e-5f;
    return layer;
}

inline formats::Clouds make_test_clouds(
    const TestLayer& layer,
    const TestThickness& thickness = [](std::uint32_t, std::uint32_t) { return 1e9; },
    std::array<std::uint8_t, 4> ground = {124, 124, 124, 255}) {
    formats::Clouds clouds;
    formats::LayerRecord record = layer.record;
    const bake::AngularTable phase = test_phase(layer.droplets);
    const bake::PeakSplit split = bake::split_peak(phase, layer.droplets.peak_angle);
    const bool has_peak = split.weight > 0;
    record.peak_angle = static_cast<float>(layer.droplets.peak_angle);
    record.phase_angles = layer.phase_angles;
    record.glow_angles = has_peak ? layer.glow_angles : 0;
    record.glow_events = has_peak ? layer.glow_events : 0;
    record.flux_depths = static_cast<std::uint32_t>(layer.flux.depths);
    record.flux_cosines = static_cast<std::uint32_t>(layer.flux.cosines);
    record.radiance_depths = static_cast<std::uint32_t>(layer.radiance.depths);
    record.radiance_cosines = static_cast<std::uint32_t>(layer.radiance.cosines);
    record.radiance_modes = static_cast<std::uint32_t>(layer.radiance.modes);
    for (std::size_t b = 0; b < 3; ++b) {
        record.band[b].kappa = static_cast<float>(layer.droplets.kappa[b]);
        record.band[b].peak_weight = static_cast<float>(split.weight);
        record.band[b].g = static_cast<float>(bake::integrate_cosine(phase));
    }
    for (std::uint32_t row = 0; row < record.rows; ++row) {
        for (std::uint32_t column = 0; column < record.columns; ++column) {
            const double highest = static_cast<double>(record.highest);
            const double share =
                highest > 0 ? std::clamp(thickness(column, row) / highest, 0.0, 1.0) : 0.0;
            clouds.thickness.push_back(static_cast<std::uint16_t>(std::lround(65535 * share)));
        }
    }
    clouds.ground.assign(record.ground_count(), ground);

    std::vector<float> band = bake::make_phase_texture(phase, record.phase_angles).log_value;
    if (has_peak) {
        const std::vector<double> moments = bake::table_moments(split.peak, bake::kGlowMoments);
        for (std::uint32_t event = 0; event < record.glow_events; ++event) {
            const double q = event / (record.glow_events - 1.0);
            for (std::uint32_t angle = 0; angle < record.glow_angles; ++angle) {
                const double s = angle / (record.glow_angles - 1.0);
                const double glow = bake::forward_glow(split, moments, 12 * q * q,
                                                       4 * layer.droplets.peak_angle * s * s);
                band.push_back(static_cast<float>(std::max(0.0, glow)));  // noise of the series
            }
        }
    }
    const bake::SlabMedium medium{bake::table_moments(split.rest, 400), 1.0};
    const bake::SlabTable flux = bake::make_slab_table(medium, layer.flux);
    for (const std::vector<float>* part : {&flux.t1, &flux.t_ms, &flux.r1, &flux.mean_t}) {
        band.insert(band.end(), part->begin(), part->end());
    }
    if (layer.radiance.depths > 0) {
        const bake::RadianceTable radiance = bake::make_radiance_table(medium, layer.radiance, 16);
        const std::size_t cosines = layer.radiance.cosines;
        for (const std::vector<float>* side : {&radiance.reflected, &radiance.transmitted}) {
            for (std::size_t i = 0; i < side->size(); ++i) {
                // A file holds the factor of cos(m phi), which is 2 for m > 0.
                const bool is_mean = i / (cosines * cosines) % layer.radiance.modes == 0;
                band.push_back((is_mean ? 1.0f : 2.0f) * (*side)[i]);
            }
        }
    }
    for (int b = 0; b < 3; ++b) {
        clouds.value.insert(clouds.value.end(), band.begin(), band.end());
    }
    clouds.records.push_back(record);
    return clouds;
}

/// Squares of the ground by turns of two colours.
inline void paint_squares(formats::Clouds& clouds, std::uint8_t first, std::uint8_t second) {
    for (std::size_t i = 0; i < clouds.ground.size(); ++i) {
        const std::uint8_t code = i % 2 == 0 ? first : second;
        clouds.ground[i] = {code, 120, static_cast<std::uint8_t>(255 - code), 255};
    }
}

}  // namespace opaline::test
