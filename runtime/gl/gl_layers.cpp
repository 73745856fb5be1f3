#include "runtime/gl/gl_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::LayerRecord;
using formats::make_error;
using formats::Rgb;

using Vec4 = std::array<float, 4>;
using Int4 = std::array<std::int32_t, 4>;

// LayerSun and Layer of layer_tables.glsl.
struct ShaderSun {
    Vec4 direction_cosine{}, irradiance_radius{}, shadow{};
};
constexpr std::size_t kMaxLevels = 16;

struct ShaderLayer {
    Vec4 rest_kappa_peak{}, kappa_haze{}, peak_weight{}, peak_square{}, field{},
        ground_cell_light{};
    Vec4 sky_irradiance{}, horizon_luminance{}, map_peak{};
    Int4 sun_discs{-1, -1, -1, -1}, field_albedo{}, levels_counts{}, counts{}, radiance_counts{};
    std::array<std::int32_t, kMaxLevels> level_first{};
    std::array<ShaderSun, kMaxLayerSuns> suns;
};
static_assert(sizeof(ShaderLayer) == 14 * 16 + kMaxLevels * 4 + kMaxLayerSuns * 48);

Vec4 vec4_of(Rgb color, float last = 0) {
    return {color.r, color.g, color.b, last};
}

std::int32_t int_of(std::size_t value) {
    return static_cast<std::int32_t>(value);
}

void fill_pyramid(const GlTexture& texture, std::span<const MipLevel<Rgb>> levels) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        glTextureSubImage2D(
            texture.name(), static_cast<GLint>(i), 0, 0, static_cast<GLsizei>(levels[i].columns),
            static_cast<GLsizei>(levels[i].rows), GL_RGB, GL_FLOAT, levels[i].value.data());
    }
}

// Shaders interpolate by themselves.
GlTexture upload_pyramid(std::span<const MipLevel<Rgb>> levels, std::size_t& resident) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlTexture texture(name);
    glTextureStorage2D(name, static_cast<GLsizei>(levels.size()), GL_RGBA32F,
                       static_cast<GLsizei>(levels[0].columns),
                       static_cast<GLsizei>(levels[0].rows));
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    fill_pyramid(texture, levels);
    for (const MipLevel<Rgb>& level : levels) {
        resident += level.value.size() * 16;
    }
    return texture;
}

formats::Status check_sizes(const LayerLight& light) {
    const auto refuse = [](std::string found) -> formats::Status {
        return make_error(ErrorKind::resource, {}, "cloud layer", "found " + std::move(found),
                          "render on the CPU");
    };
    GLint side = 0;
    GLint64 block = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    const LayerRecord& record = light.record;
    const std::uint32_t ground = std::max(record.ground_columns, record.ground_rows);
    if (ground > static_cast<std::uint32_t>(side)) {
        return refuse("a picture of " + std::to_string(ground) +
                      " pixels a side, the OpenGL driver takes at most " + std::to_string(side));
    }
    std::size_t texels = 0;
    for (const MipLevel<float>& level : light.field.thickness.level)
        texels += level.value.size();
    const std::size_t most =
        std::min<std::size_t>(static_cast<std::size_t>(std::max<GLint64>(block, 0)) / sizeof(float),
                              std::numeric_limits<std::int32_t>::max());
    if (texels > most || light.field.thickness.level.size() > kMaxLevels) {
        return refuse(std::to_string(texels) + " texels of thickness with their means, " +
                      std::to_string(record.columns) + " x " + std::to_string(record.rows) +
                      "; the OpenGL driver takes at most " + std::to_string(most) +
                      ", the shader 65535 a side");
    }
    return formats::ok_status();
}

// A damaged file may hold what not all drivers handle.
float tame_entry(float value, float low, float high) {
    return value > low ? std::min(value, high) : low;
}

GlBuffer upload_phase(const LayerLight& light, std::size_t& resident) {
    std::vector<float> values;
    for (std::size_t i = 0; i < light.record.phase_angles; ++i) {
        for (const formats::LayerTables& tables : light.tables) {
            values.push_back(tame_entry(tables.log_phase[i], -80, 80));
        }
    }
    return make_buffer_of(std::span<const float>(values), resident);
}

GlBuffer upload_table(const LayerLight& light, std::span<const float> formats::LayerTables::*table,
                      float high, std::size_t& resident) {
    std::vector<float> values;
    for (const formats::LayerTables& tables : light.tables) {
        for (const float value : tables.*table) {
            values.push_back(tame_entry(value, 0, high));
        }
    }
    return make_buffer_of(std::span<const float>(values), resident);
}

GlBuffer upload_thickness(const LayerLight& light, std::size_t& resident) {
    std::vector<float> texels;
    for (const MipLevel<float>& level : light.field.thickness.level) {
        texels.insert(texels.end(), level.value.begin(), level.value.end());
    }
    return make_buffer_of(std::span<const float>(texels), resident);
}

formats::Status upload_layer(GlLayers& layers, const LayerLight& light) {
    if (auto status = check_sizes(light); !status) return status;
    layers.thickness = upload_thickness(light, layers.layer_bytes);
    layers.frames = light.field.frames;
    layers.albedo =
        upload_pyramid(std::span<const MipLevel<Rgb>>(light.albedo.level), layers.layer_bytes);
    layers.phase = upload_phase(light, layers.layer_bytes);
    layers.flux = upload_table(light, &formats::LayerTables::t_ms, 1, layers.layer_bytes);
    layers.glow = upload_table(light, &formats::LayerTables::glow, 1e30f, layers.layer_bytes);
    return check_gl("uploading a cloud layer");
}

// T_ms and T_1 of a sun's flux by depth and band.
void append_sun_flux(const LayerLight& light, const LitSun& sun, std::vector<float>& values) {
    const std::size_t cosines = light.record.flux_cosines;
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

void upload_suns(GlLayers& layers, const LayerLight& light) {
    std::vector<float> flux, tables;
    for (const LitSun& sun : light.sun) {
        append_sun_flux(light, sun, flux);
        for (const Rgb value : sun.table.value) {
            for (const float v : {value.r, value.g, value.b}) {
                tables.push_back(std::isfinite(v) ? std::clamp(v, -1e30f, 1e30f) : 0);
            }
        }
    }
    layers.sun_flux = make_buffer_of(std::span<const float>(flux), layers.light_bytes);
    layers.sun_tables = make_buffer_of(std::span<const float>(tables), layers.light_bytes);
}

ShaderLayer shader_layer(const LayerLight& light) {
    const LayerRecord& r = light.record;
    ShaderLayer block;
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
    block.sky_irradiance = vec4_of(light.sky.irradiance);
    block.horizon_luminance = vec4_of(light.sky.horizon, std::min(light.sky.sun_luminance, 1e38f));
    block.map_peak = {light.sky.peak.x, light.sky.peak.y, light.sky.peak.z, light.sky.peak_cosine};
    for (std::size_t i = 0; i < light.sky.sun_discs.size(); ++i) {
        block.sun_discs[i] = int_of(light.sky.sun_discs[i]);
    }
    block.field_albedo = {int_of(r.columns), int_of(r.rows), int_of(r.ground_columns),
                          int_of(r.ground_rows)};
    block.levels_counts = {int_of(light.field.thickness.level.size() - 1),
                           int_of(light.albedo.level.size() - 1), int_of(r.phase_angles),
                           int_of(r.glow_angles)};
    block.counts = {int_of(r.glow_events), int_of(r.flux_depths), int_of(r.flux_cosines), 0};
    block.radiance_counts = {int_of(r.radiance_depths), int_of(r.radiance_cosines), 0, 0};
    std::size_t first = 0;
    for (std::size_t i = 0; i < light.field.thickness.level.size(); ++i) {
        block.level_first[i] = int_of(first);
        first += light.field.thickness.level[i].value.size();
    }
    for (std::size_t i = 0; i < light.sun.size(); ++i) {
        const LitSun& sun = light.sun[i];
        block.suns[i].direction_cosine = {sun.direction.x, sun.direction.y, sun.direction.z,
                                          sun.cosine};
        block.suns[i].irradiance_radius = vec4_of(sun.irradiance, light.sky.suns[i].angular_radius);
        block.suns[i].shadow = {sun.shadow_x, sun.shadow_z, sun.shadow_blur, 0};
    }
    return block;
}

std::string list_defines(const LayerLight& light) {
    const auto define = [](const char* name, std::size_t value) {
        return std::string("#define ") + name + " " + std::to_string(value) + "\n";
    };
    return define("SUNS", light.sun.size()) + define("REPEAT", light.field.repeats() ? 1 : 0) +
           define("MODES", light.record.radiance_depths > 0 ? light.record.radiance_modes : 0) +
           define("GLOW", light.record.glow_count() > 0 ? 1 : 0);
}

}  // namespace

formats::Status relight_gl_layers(GlLayers& layers, const LayerLight& light) {
    if (!layers.shown) {
        layers.layer_bytes = 0;
        if (auto status = upload_layer(layers, light); !status) return status;
    } else if (layers.frames != light.field.frames) {
        std::size_t resident = 0;  // as much as before
        layers.thickness = upload_thickness(light, resident);
        layers.frames = light.field.frames;
    }
    layers.light_bytes = 0;
    upload_suns(layers, light);
    layers.ground_light = upload_pyramid(
        std::span<const MipLevel<Rgb>>(&light.ground_light.cell, 1), layers.light_bytes);
    layers.base_light = upload_pyramid(std::span<const MipLevel<Rgb>>(&light.base_light.cell, 1),
                                       layers.light_bytes);
    const ShaderLayer block = shader_layer(light);
    layers.block = make_buffer_of(std::span<const ShaderLayer>(&block, 1), layers.light_bytes);
    layers.defines = list_defines(light);
    layers.suns = light.sky.suns;
    const LayerRecord& record = light.record;
    const double size_x = static_cast<double>(record.size[0]);
    const double size_z = static_cast<double>(record.size[1]);
    const bool repeats = light.field.repeats();
    layers.field = {light.field.low_x, light.field.low_z, size_x, size_z, repeats};
    layers.ground = {static_cast<double>(record.center[0]) - size_x / 2,
                     static_cast<double>(record.center[1]) - size_z / 2, size_x, size_z, repeats};
    layers.light = {light.ground_light.low_x, light.ground_light.low_z, light.ground_light.size_x,
                    light.ground_light.size_z, repeats};
    layers.base = static_cast<double>(record.base);
    layers.ground_height = static_cast<double>(record.ground);
    auto status = check_gl("uploading the light of a cloud layer");
    layers.shown = status.has_value();
    return status;
}

}  // namespace opaline::runtime
