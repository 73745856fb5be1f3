#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "formats/opal/asset.h"

namespace opaline::tests {

/// What a layer of `add_layer` is to be like.
struct LayerShape {
    bool has_peak = true;      ///< and glow
    bool has_radiance = true;  ///< light of two scatterings or more
    std::uint32_t flags = formats::LayerRecord::kRadiosity | formats::LayerRecord::kLoop;
};

/// Tables of flux of one band: T = 1 / (1 + tau / 5), a random part of what it scatters is T_1, and
/// of the rest R_1.
inline void append_flux(const formats::LayerRecord& layer, std::mt19937& generator,
                        std::vector<float>& values) {
    std::uniform_real_distribution<float> uniform(0.0f, 0.5f);
    std::vector<float> t1, t_ms, r1, mean_t;
    for (std::uint32_t i = 0; i < layer.flux_depths; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(layer.flux_depths - 1);
        const float depth =
            share < 1 ? share / (1 - share) : std::numeric_limits<float>::infinity();
        mean_t.push_back(1 / (1 + depth / 5));
        for (std::uint32_t j = 0; j < layer.flux_cosines; ++j) {
            const float root = static_cast<float>(j) / static_cast<float>(layer.flux_cosines - 1);
            const float t_0 = j == 0 ? 0.0f : std::exp(-depth / (root * root));
            t_ms.push_back(std::max(mean_t.back(), t_0));
            t1.push_back(uniform(generator) * (t_ms.back() - t_0));
            r1.push_back(uniform(generator) * (1 - t_ms.back()));
        }
    }
    for (const auto& table : {t1, t_ms, r1, mean_t}) {
        values.insert(values.end(), table.begin(), table.end());
    }
}

/// Adds a layer of random thickness, ground and tables, all tiny.
inline void add_layer(formats::Asset& asset, const LayerShape& shape = {}) {
    using namespace formats;
    Clouds& clouds = asset.clouds;
    std::mt19937 generator(5), later(6);  // of all that there was at first; of further frames
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::uniform_int_distribution<std::uint32_t> code(0, 65535);
    LayerRecord layer;
    layer.base = 800;
    layer.ground = -20;
    layer.center = {100, -300};
    layer.size = {4000, 3000};
    layer.wind = {5, -2.5f};
    layer.highest = 250;
    layer.peak_angle = shape.has_peak ? 0.0875f : 0;
    layer.haze = 1e-4f;
    layer.flags = shape.flags;
    layer.columns = 4;
    layer.rows = 3;
    layer.ground_columns = 2;
    layer.ground_rows = 3;
    layer.frames = 2;
    layer.frame_seconds = 90;
    layer.phase_angles = 5;
    layer.glow_angles = shape.has_peak ? 3 : 0;
    layer.glow_events = shape.has_peak ? 2 : 0;
    layer.flux_depths = 4;
    layer.flux_cosines = 3;
    layer.radiance_depths = shape.has_radiance ? 2 : 0;
    layer.radiance_cosines = shape.has_radiance ? 3 : 0;
    layer.radiance_modes = shape.has_radiance ? 2 : 0;
    for (std::size_t b = 0; b < 3; ++b) {
        const auto step = static_cast<float>(b);
        layer.band[b].kappa = 0.05f - 0.002f * step;
        layer.band[b].peak_weight = shape.has_peak ? 0.44f + 0.01f * step : 0;
        layer.band[b].g = 0.85f;
    }
    layer.first_thickness = clouds.thickness.size();
    layer.first_ground = clouds.ground.size();
    layer.first_value = clouds.value.size();
    for (std::size_t i = 0; i < layer.thickness_count(); ++i) {
        clouds.thickness.push_back(
            static_cast<std::uint16_t>(i < layer.frame_count() ? code(generator) : code(later)));
    }
    for (std::size_t i = 0; i < layer.ground_count(); ++i) {
        const auto grey = static_cast<std::uint8_t>(40 * i);
        clouds.ground.push_back({grey, 128, static_cast<std::uint8_t>(255 - grey), 255});
    }
    const auto add = [&](std::size_t count, float low, float high) {
        for (std::size_t i = 0; i < count; ++i) {
            clouds.value.push_back(low + (high - low) * uniform(generator));
        }
    };
    for (std::size_t b = 0; b < 3; ++b) {
        add(layer.phase_angles, -3, -2);  // of 1 / (4 pi) it is -2.53
        add(layer.glow_count(), 0, 20);
        append_flux(layer, generator, clouds.value);
        add(2 * layer.radiance_count(), -0.1f, 1);
    }
    clouds.records.push_back(layer);
}

/// A sound asset of one layer and nothing else, n = 8.
inline formats::Asset make_cloud_asset(const LayerShape& shape = {}) {
    formats::Asset asset;
    asset.provenance = R"({"generator":"test"})";
    asset.transport = formats::make_sparse_rows(8, 8);
    add_layer(asset, shape);
    return asset;
}

}  // namespace opaline::tests
