#include "runtime/gl/gl_environment.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::ErrorKind;
using formats::make_error;

formats::Status upload_map(const Environment& environment, GlNames& names, GlEnvironment& gl) {
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
    gl.texture = names.make_array_texture();
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, static_cast<GLsizei>(width),
                 static_cast<GLsizei>(height), static_cast<GLsizei>(layers), 0, GL_RGB, GL_FLOAT,
                 environment.pixel.data());
    gl.map = is_cube ? GlEnvironment::Map::cube : GlEnvironment::Map::lat_long;
    return formats::ok_status();
}

}  // namespace

formats::Result<GlEnvironment> upload_environment(const Environment& environment,
                                                  const GlFunctions& functions, GlNames& names) {
    GlEnvironment gl;
    gl.u_offset = environment.u_offset;
    gl.u_sign = environment.u_sign;
    gl.rows_include_poles = environment.rows_include_poles;
    if (!environment.pixel.empty()) {
        if (const auto status = upload_map(environment, names, gl); !status) return status.error();
    }
    std::vector<float> discs;
    for (const formats::DistantDisc& disc : environment.discs) {
        const float chord = 2.0f * std::sin(0.5f * disc.angular_radius);
        discs.insert(discs.end(), {disc.direction.x, disc.direction.y, disc.direction.z, chord,
                                   disc.radiance.r, disc.radiance.g, disc.radiance.b, 0.0f});
    }
    if (discs.empty()) discs.resize(8);
    gl.discs = names.make_table_texture();
    fill_table(functions, gl.discs, 2, discs);
    gl.disc_count = static_cast<std::int32_t>(environment.discs.size());
    if (const auto status = check_gl(functions, "uploading the environment"); !status)
        return status.error();
    return gl;
}

}  // namespace opaline::runtime
