#include "runtime/gl/gl_environment.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "formats/opal/ggx_albedo.h"
#include "runtime/gloss_tables.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::ErrorKind;
using formats::make_error;

GlTexture upload_layers(const Environment& map, std::uint32_t width, std::uint32_t height,
                        std::uint32_t layers, std::size_t& resident) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    glTextureStorage3D(name, 1, GL_RGBA32F, static_cast<GLsizei>(width),
                       static_cast<GLsizei>(height), static_cast<GLsizei>(layers));
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage3D(name, 0, 0, 0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                        static_cast<GLsizei>(layers), GL_RGB, GL_FLOAT, map.pixel.data());
    resident += 16 * map.pixel.size();
    return GlTexture(name);
}

formats::Status upload_map(const Environment& environment, GlEnvironment& gl) {
    const bool is_cube = environment.layout == Environment::Layout::cube;
    const std::uint32_t width = environment.width,
                        height = is_cube ? environment.width : environment.height;
    const std::uint32_t layers = is_cube ? 6 : 1;
    if (environment.pixel.size() != std::size_t{width} * height * layers ||
        (is_cube && std::uint64_t{environment.height} != 6 * std::uint64_t{width})) {
        return make_error(ErrorKind::usage, {}, "environment",
                          "found " + std::to_string(environment.pixel.size()) + " pixels for " +
                              std::to_string(width) + "x" + std::to_string(environment.height));
    }
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (std::max(width, height) > static_cast<std::uint32_t>(limit)) {
        return make_error(ErrorKind::resource, {}, "environment",
                          "found " + std::to_string(width) + "x" + std::to_string(height) +
                              " pixels, the OpenGL driver takes at most " + std::to_string(limit),
                          std::string(kRenderOnCpu) + ", or use a smaller map");
    }
    gl.texture = upload_layers(environment, width, height, layers, gl.resident);
    gl.map = is_cube ? GlEnvironment::Map::cube : GlEnvironment::Map::lat_long;
    return formats::ok_status();
}

void upload_gloss_light(const GlossLight& light, GlSpecular& gl) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    gl.light_maps = GlTexture(name);
    glTextureStorage3D(name, static_cast<GLsizei>(light.map.size()), GL_RGBA32F,
                       static_cast<GLsizei>(light.map[0].width),
                       static_cast<GLsizei>(light.map[0].width), 6);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (std::size_t level = 0; level < light.map.size(); ++level) {
        const Environment& map = light.map[level];
        const auto size = static_cast<GLsizei>(map.width);
        glTextureSubImage3D(name, static_cast<GLint>(level), 0, 0, 0, size, size, 6, GL_RGB,
                            GL_FLOAT, map.pixel.data());
        gl.resident += 16 * map.pixel.size();
    }
    const std::vector<float> cells = make_cell_table(light), suns = make_sun_table(light);
    gl.cells = make_buffer_of(std::span<const float>(cells), gl.resident);
    gl.suns = make_buffer_of(std::span<const float>(suns), gl.resident);
    gl.suns_count = static_cast<std::int32_t>(light.suns.size());
    gl.albedo = make_buffer_of(formats::ggx_albedo_table(), gl.resident);
}

}  // namespace

formats::Result<GlEnvironment> upload_environment(const Environment& environment) {
    GlEnvironment gl;
    gl.u_offset = environment.u_offset;
    gl.u_sign = environment.u_sign;
    gl.rows_include_poles = environment.rows_include_poles;
    if (!environment.pixel.empty()) {
        if (const auto status = upload_map(environment, gl); !status) return status.error();
    }
    std::vector<float> discs;
    for (const formats::DistantDisc& disc : environment.discs) {
        const float chord = 2.0f * std::sin(0.5f * disc.angular_radius);
        discs.insert(discs.end(), {disc.direction.x, disc.direction.y, disc.direction.z, chord,
                                   disc.radiance.r, disc.radiance.g, disc.radiance.b, 0.0f});
    }
    gl.discs = make_buffer_of(std::span<const float>(discs), gl.resident);
    gl.disc_count = static_cast<std::int32_t>(environment.discs.size());
    if (const auto status = check_gl("uploading the environment"); !status) return status.error();
    return gl;
}

formats::Result<GlSpecular> upload_specular(SpecularLight light) {
    GlSpecular gl;
    for (SpecularLight::Map& map : light.maps) {
        const std::uint32_t size = map.radiance.width;
        gl.texture.push_back(upload_layers(map.radiance, size, size, 6, gl.resident));
        map.radiance.pixel = {};
    }
    if (!light.gloss.map.empty()) {
        upload_gloss_light(light.gloss, gl);
        light.gloss = {};
    }
    gl.light = std::move(light);
    if (const auto status = check_gl("uploading specular light"); !status) return status.error();
    return gl;
}

}  // namespace opaline::runtime
