#include "runtime/gl/gl_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opaline::runtime {

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
