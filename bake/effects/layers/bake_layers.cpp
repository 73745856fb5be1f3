#include "bake/effects/layers/bake_layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/effects/layers/layer_knobs.h"
#include "bake/effects/layers/layer_tables.h"
#include "bake/effects/layers/plan_layers.h"

namespace opaline::bake {
namespace {

constexpr double kMostCode = 65535;
/// Contrast falls by e^-(haze distance); at the visibility it is 5 %.
const double kVisibleDepth = std::log(20.0);

float as_float(double value) {
    return static_cast<float>(value);
}

// Where layer and ground are.
formats::LayerRecord place_record(const formats::CloudLayer& layer) {
    formats::LayerRecord record;
    record.base = as_float(layer.base);
    record.ground = as_float(layer.ground);
    record.center = {as_float(layer.center.x), as_float(layer.center.y)};
    record.size = {as_float(layer.size.x), as_float(layer.size.y)};
    record.haze = layer.visibility > 0 ? as_float(kVisibleDepth / layer.visibility) : 0;
    record.flags = layer.repeats ? formats::LayerRecord::kRepeat : 0;
    record.ground_columns = layer.ground_columns;
    record.ground_rows = layer.ground_rows;
    return record;
}

formats::LayerRecord make_record(const formats::CloudLayer& layer, const LayerLayout& layout,
                                 const DropletBands& bands, const LayerTableSizes& sizes) {
    formats::LayerRecord record = place_record(layer);
    record.wind = {as_float(layer.wind.x), as_float(layer.wind.y)};
    record.highest = *std::ranges::max_element(layer.thickness);
    record.peak_angle = as_float(bands[1].split.angle);
    record.flags |= (layout.radiosity ? formats::LayerRecord::kRadiosity : 0) |
                    (layer.paper ? formats::LayerRecord::kPaper : 0);
    record.columns = layer.columns;
    record.rows = layer.rows;
    record.frames = layer.frames;
    if (layer.frames > 1) {
        record.frame_seconds = as_float(layer.frame_seconds);
        record.flags |= layer.loops ? formats::LayerRecord::kLoop : 0;
    }
    record.phase_angles = sizes.phase_angles;
    if (record.peak_angle > 0) {
        record.glow_angles = sizes.glow_angles;
        record.glow_events = sizes.glow_events;
    }
    record.flux_depths = static_cast<std::uint32_t>(sizes.flux.depths);
    record.flux_cosines = static_cast<std::uint32_t>(sizes.flux.cosines);
    if (layout.often) {
        record.radiance_depths = static_cast<std::uint32_t>(sizes.radiance.depths);
        record.radiance_cosines = static_cast<std::uint32_t>(sizes.radiance.cosines);
        record.radiance_modes = static_cast<std::uint32_t>(sizes.radiance.modes);
    }
    for (std::size_t band = 0; band < bands.size(); ++band) {
        record.band[band].kappa = as_float(bands[band].kappa);
        record.band[band].peak_weight = as_float(bands[band].split.weight);
        record.band[band].g = as_float(bands[band].optics.g);
    }
    return record;
}

void append_thickness(const formats::CloudLayer& layer, formats::LayerRecord& record,
                      formats::Clouds& clouds) {
    record.first_thickness = clouds.thickness.size();
    const double scale = kMostCode / static_cast<double>(record.highest);
    for (const float thickness : layer.thickness) {
        clouds.thickness.push_back(
            static_cast<std::uint16_t>(std::lround(scale * static_cast<double>(thickness))));
    }
}

void append_ground(const formats::CloudLayer& layer, formats::LayerRecord& record,
                   formats::Clouds& clouds) {
    record.first_ground = clouds.ground.size();
    if (layer.ground_albedo.empty()) {  // a black one
        record.ground_columns = record.ground_rows = 1;
        clouds.ground.push_back({0, 0, 0, 255});
    }
    clouds.ground.insert(clouds.ground.end(), layer.ground_albedo.begin(),
                         layer.ground_albedo.end());
}

// The ground beneath a layer of no thickness, with tables as small as the format allows: all light
// goes through.
void append_bare_ground(const formats::CloudLayer& layer, formats::Clouds& clouds) {
    formats::LayerRecord record = place_record(layer);
    record.columns = record.rows = 1;
    record.phase_angles = record.flux_depths = record.flux_cosines = 2;
    record.first_thickness = clouds.thickness.size();
    clouds.thickness.push_back(0);
    append_ground(layer, record, clouds);
    record.first_value = clouds.value.size();
    const auto append = [&](std::size_t count, float value) {
        clouds.value.insert(clouds.value.end(), count, value);
    };
    for (std::size_t band = 0; band < record.band.size(); ++band) {
        append(record.phase_angles, -std::log(4 * std::numbers::pi_v<float>));
        append(record.flux_count(), 0);  // T_1
        append(record.flux_count(), 1);  // T
        append(record.flux_count(), 0);  // R_1
        append(record.flux_depths, 1);   // of even light
    }
    clouds.records.push_back(record);
}

}  // namespace

RadiusSampling radius_sampling(const Knobs& knobs) {
    // With fewer radii than this, small droplets show the ripples of single spheres.
    constexpr unsigned kLeast = 200, kMost = 8000;
    return {knobs[kCloudStep], kLeast, kMost};
}

formats::Result<BakedLayers> bake_layers(const LayerJob& job, const Context& context,
                                         StageLog& log) {
    const LayerTableSizes sizes = layer_table_sizes(job.knobs);
    BakedLayers baked;
    for (const LayerLayout& layout : job.layouts) {
        const formats::CloudLayer& layer = job.scene.layers[layout.layer];
        if (!layout.cloud) {
            append_bare_ground(layer, baked.clouds);
            baked.droplets.emplace_back();
            continue;
        }
        auto droplets =
            run_stage(log, "droplets of clouds", std::string(kCloud), [&](std::uint64_t&) {
                return scatter_bands(layer, radius_sampling(job.knobs), context);
            });
        if (!droplets) return std::move(droplets).error();
        formats::LayerRecord record = make_record(layer, layout, *droplets, sizes);
        append_thickness(layer, record, baked.clouds);
        append_ground(layer, record, baked.clouds);
        record.first_value = baked.clouds.value.size();
        run_stage(log, "tables of clouds", std::string(kCloud), [&](std::uint64_t&) {
            for (const DropletBand& band : *droplets) {
                const auto values =
                    make_band_tables(band, sizes, {layout.often, layer.paper}, context);
                baked.clouds.value.insert(baked.clouds.value.end(), values.begin(), values.end());
            }
            return true;
        });
        if (context.cancelled()) return interrupted();
        baked.clouds.records.push_back(record);
        baked.droplets.push_back(std::move(*droplets));
    }
    return baked;
}

}  // namespace opaline::bake
