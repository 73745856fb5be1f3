#include "runtime/gl/gl_layers.h"

#include <algorithm>
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
                          kRenderOnCpu);
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
    if (texels > most || light.field.thickness.level.size() > kMaxLayerLevels) {
        return refuse(std::to_string(texels) + " texels of thickness with their means, " +
                      std::to_string(record.columns) + " x " + std::to_string(record.rows) +
                      "; the OpenGL driver takes at most " + std::to_string(most) +
                      ", the shader 65535 a side");
    }
    return formats::ok_status();
}

GlBuffer upload_floats(const std::vector<float>& values, std::size_t& resident) {
    return make_buffer_of(std::span<const float>(values), resident);
}

formats::Status upload_layer(GlLayers& layers, const LayerLight& light) {
    if (auto status = check_sizes(light); !status) return status;
    layers.thickness = upload_floats(pack_thickness(light), layers.layer_bytes);
    layers.frames = light.field.frames;
    layers.albedo =
        upload_pyramid(std::span<const MipLevel<Rgb>>(light.albedo.level), layers.layer_bytes);
    layers.phase = upload_floats(pack_layer_phase(light), layers.layer_bytes);
    layers.flux = upload_floats(pack_layer_flux(light), layers.layer_bytes);
    layers.glow = upload_floats(pack_layer_glow(light), layers.layer_bytes);
    return check_gl("uploading a cloud layer");
}

std::string list_defines(const LayerLight& light) {
    const auto define = [](const char* name, std::size_t value) {
        return std::string("#define ") + name + " " + std::to_string(value) + "\n";
    };
    const LayerKind kind = layer_kind(light);
    return define("SUNS", light.sun.size()) + define("REPEAT", kind.repeats ? 1 : 0) +
           define("MODES", kind.modes) + define("GLOW", kind.glows ? 1 : 0);
}

}  // namespace

formats::Status relight_gl_layers(GlLayers& layers, const LayerLight& light) {
    if (!layers.shown) {
        layers.layer_bytes = 0;
        if (auto status = upload_layer(layers, light); !status) return status;
    } else if (layers.frames != light.field.frames) {
        std::size_t resident = 0;  // as much as before
        layers.thickness = upload_floats(pack_thickness(light), resident);
        layers.frames = light.field.frames;
    }
    layers.light_bytes = 0;
    layers.sun_flux = upload_floats(pack_sun_flux(light), layers.light_bytes);
    layers.sun_tables = upload_floats(pack_sun_tables(light), layers.light_bytes);
    layers.ground_light = upload_pyramid(
        std::span<const MipLevel<Rgb>>(&light.ground_light.cell, 1), layers.light_bytes);
    layers.base_light = upload_pyramid(std::span<const MipLevel<Rgb>>(&light.base_light.cell, 1),
                                       layers.light_bytes);
    const ShaderLayer block = make_shader_layer(light);
    layers.block = make_buffer_of(std::span<const ShaderLayer>(&block, 1), layers.light_bytes);
    layers.defines = list_defines(light);
    layers.suns = light.sky.suns;
    layers.places = layer_places(light);
    auto status = check_gl("uploading the light of a cloud layer");
    layers.shown = status.has_value();
    return status;
}

}  // namespace opaline::runtime
