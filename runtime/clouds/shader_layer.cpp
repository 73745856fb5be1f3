#include "runtime/clouds/shader_layer.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace opaline::runtime {
namespace {

using formats::LayerRecord;
using formats::Rgb;

ShaderLayer::Vec4 vec4_of(Rgb color, float last = 0) {
    return {color.r, color.g, color.b, last};
}

std::int32_t int_of(std::size_t value) {
    return static_cast<std::int32_t>(value);
}

float tame_entry(float value, float low, float high) {
    return value > low ? std::min(value, high) : low;
}

std::vector<float> pack_table(const LayerLight& light,
                              std::span<const float> formats::LayerTables::*table, float high) {
    std::vector<float> values;
    for (const formats::LayerTables& tables : light.tables) {
        for (const float value : tables.*table) {
            values.push_back(tame_entry(value, 0, high));
        }
    }
    return values;
}

void set_record(const LayerLight& light, ShaderLayer& block) {
    const LayerRecord& r = light.record;
    for (std::size_t b = 0; b < 3; ++b) {
        block.rest_kappa_peak[b] = light.rest_kappa[b];
        block.kappa_haze[b] = r.band[b].kappa;
        block.peak_weight[b] = r.band[b].peak_weight;
        block.peak_square[b] = light.peak_mean_square[b];
    }
    block.rest_kappa_peak[3] = r.peak_angle;
    block.kappa_haze[3] = r.haze;
    block.field = {r.size[0], r.size[1], static_cast<float>(light.field.cell), r.highest};
    block.ground_cell_light = {
        static_cast<float>(std::max(static_cast<double>(r.size[0]) / r.ground_columns,
                                    static_cast<double>(r.size[1]) / r.ground_rows)),
        0, static_cast<float>(light.ground_light.size_x),
        static_cast<float>(light.ground_light.size_z)};
    block.field_albedo = {int_of(r.columns), int_of(r.rows), int_of(r.ground_columns),
                          int_of(r.ground_rows)};
    block.levels_counts = {int_of(light.field.thickness.level.size() - 1),
                           int_of(light.albedo.level.size() - 1), int_of(r.phase_angles),
                           int_of(r.glow_angles)};
    block.counts = {int_of(r.glow_events), int_of(r.flux_depths), int_of(r.flux_cosines), 0};
    block.radiance_counts = {int_of(r.radiance_depths), int_of(r.radiance_cosines),
                             int_of(light.sun.size()), 0};
}

void set_light(const LayerLight& light, ShaderLayer& block) {
    block.sky_irradiance = vec4_of(light.sky.irradiance);
    block.horizon_luminance = vec4_of(light.sky.horizon, std::min(light.sky.sun_luminance, 1e38f));
    block.map_peak = {light.sky.peak.x, light.sky.peak.y, light.sky.peak.z, light.sky.peak_cosine};
    for (std::size_t i = 0; i < light.sky.sun_discs.size(); ++i) {
        block.sun_discs[i] = int_of(light.sky.sun_discs[i]);
    }
    for (std::size_t i = 0; i < light.sun.size(); ++i) {
        const LitSun& sun = light.sun[i];
        block.suns[i].direction_cosine = {sun.direction.x, sun.direction.y, sun.direction.z,
                                          sun.cosine};
        block.suns[i].irradiance_radius = vec4_of(sun.irradiance, light.sky.suns[i].angular_radius);
        block.suns[i].shadow = {sun.shadow_x, sun.shadow_z, sun.shadow_blur, 0};
    }
}

}  // namespace

ShaderLayer make_shader_layer(const LayerLight& light) {
    ShaderLayer block;
    set_record(light, block);
    set_light(light, block);
    std::size_t first = 0;
    for (std::size_t i = 0; i < light.field.thickness.level.size(); ++i) {
        block.level_first[i] = int_of(first);
        first += light.field.thickness.level[i].value.size();
    }
    return block;
}

std::vector<float> pack_thickness(const LayerLight& light) {
    std::vector<float> texels;
    for (const MipLevel<float>& level : light.field.thickness.level) {
        texels.insert(texels.end(), level.value.begin(), level.value.end());
    }
    return texels;
}

std::vector<float> pack_layer_phase(const LayerLight& light) {
    std::vector<float> values;
    for (std::size_t i = 0; i < light.record.phase_angles; ++i) {
        for (const formats::LayerTables& tables : light.tables) {
            values.push_back(tame_entry(tables.log_phase[i], -80, 80));
        }
    }
    return values;
}

std::vector<float> pack_layer_flux(const LayerLight& light) {
    return pack_table(light, &formats::LayerTables::t_ms, 1);
}

std::vector<float> pack_layer_glow(const LayerLight& light) {
    return pack_table(light, &formats::LayerTables::glow, 1e30f);
}

std::vector<float> pack_sun_flux(const LayerLight& light) {
    std::vector<float> values;
    const std::size_t cosines = light.record.flux_cosines;
    for (const LitSun& sun : light.sun) {
        const TablePlace place = place_on_axis(std::sqrt(sun.cosine), cosines);
        for (std::size_t depth = 0; depth < light.record.flux_depths; ++depth) {
            for (const formats::LayerTables& tables : light.tables) {
                for (const auto& table : {tables.t_ms, tables.t1}) {
                    const std::size_t i = depth * cosines + place.first;
                    const float value = table[i] + place.share * (table[i + 1] - table[i]);
                    values.push_back(tame_entry(value, 0, 1));
                }
            }
        }
    }
    return values;
}

std::vector<float> pack_sun_tables(const LayerLight& light) {
    std::vector<float> values;
    for (const LitSun& sun : light.sun) {
        for (const Rgb value : sun.table.value) {
            for (const float v : {value.r, value.g, value.b}) {
                values.push_back(std::isfinite(v) ? std::clamp(v, -1e30f, 1e30f) : 0);
            }
        }
    }
    return values;
}

LayerKind layer_kind(const LayerLight& light) {
    return {light.field.repeats(), light.record.glow_count() > 0,
            light.record.radiance_depths > 0 ? light.record.radiance_modes : 0};
}

std::array<float, 2> LayerGrid::place_of(formats::Vec3 point) const {
    const auto share = [this](float at, double low, double size) {
        const double place = (static_cast<double>(at) - low) / size;
        return static_cast<float>(repeats ? place - std::floor(place) : place);
    };
    return {share(point.x, low_x, size_x), share(point.z, low_z, size_z)};
}

LayerPlaces layer_places(const LayerLight& light) {
    const LayerRecord& record = light.record;
    const double size_x = static_cast<double>(record.size[0]);
    const double size_z = static_cast<double>(record.size[1]);
    const bool repeats = light.field.repeats();
    LayerPlaces places;
    places.field = {light.field.low_x, light.field.low_z, size_x, size_z, repeats};
    places.ground = {static_cast<double>(record.center[0]) - size_x / 2,
                     static_cast<double>(record.center[1]) - size_z / 2, size_x, size_z, repeats};
    places.light = {light.ground_light.low_x, light.ground_light.low_z, light.ground_light.size_x,
                    light.ground_light.size_z, repeats};
    places.base = static_cast<double>(record.base);
    places.ground_height = static_cast<double>(record.ground);
    return places;
}

}  // namespace opaline::runtime
