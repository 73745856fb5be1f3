#include "runtime/gl/gl_scene.h"

#include <algorithm>
#include <array>
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

double view_unit(const Camera& camera) {
    const formats::Vec3 to_target = camera.target - camera.eye;
    const double distance =
        std::hypot(static_cast<double>(to_target.x), static_cast<double>(to_target.y),
                   static_cast<double>(to_target.z));
    return 1.0 / std::max(distance, static_cast<double>(camera.near_plane));
}

void set_vec3(GLuint program, GLint location, formats::Vec3 v) {
    glProgramUniform3f(program, location, v.x, v.y, v.z);
}

void set_rays(const TileView& view, GLuint program, GLint first) {
    const CameraFrame& frame = view.frame;
    const TileGrid& grid = view.grid;
    glProgramUniform2f(program, first, grid.first_column, grid.first_row);
    glProgramUniform2f(program, first + 1, 2.0f / grid.columns, 2.0f / grid.rows);
    set_vec3(program, first + 2, static_cast<float>(frame.tan_half_x) * frame.right);
    set_vec3(program, first + 3, static_cast<float>(-frame.tan_half_y) * frame.up);
    set_vec3(program, first + 4, -1.0f * frame.backward);
}

void set_light_from_world(const Rotation& r, GLuint program, GLint location) {
    // Rows are the light's axes, so that the product is light_from_world.
    const std::array<float, 9> rows{r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z};
    glProgramUniformMatrix3fv(program, location, 1, GL_TRUE, rows.data());
}

void bind_environment(const GlEnvironment& environment, const Rotation& rotation, GLuint program,
                      GLint first) {
    set_light_from_world(rotation, program, first);
    glUniform1i(first + 1, static_cast<GLint>(environment.map));
    glUniform2f(first + 2, environment.u_offset, environment.u_sign);
    glUniform1i(first + 3, environment.rows_include_poles ? 1 : 0);
    glUniform1i(first + 4, environment.disc_count);
    glBindTextureUnit(0, environment.texture);
    glBindTextureUnit(4, environment.discs);
}

}  // namespace opaline::runtime
