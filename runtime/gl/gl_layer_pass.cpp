#include "runtime/gl/gl_layer_pass.h"

#include <array>
#include <cstdint>
#include <string>

#include "runtime/picture/layer_pass.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of layers.frag.glsl, and of what comes before it; 5 to 9 are the environment's.
enum Uniform : GLint {
    kTileOrigin = 0,  // set_rays
    kEnvironment = 5,
    kSpread = 12,
    kNearPlane = 16,
    kSupersampling,
    kSeesCorners,
    kShowsSky
};

void bind_layer(const opaline_gl_layer& layer) {
    const std::array<GLuint, 3> pictures{layer.albedo_map, layer.ground_light, layer.base_light};
    glBindTextures(5, static_cast<GLsizei>(pictures.size()), pictures.data());
    const std::array<GLuint, 3> lines{layer.table_values, layer.sun_values, layer.thickness_values};
    glBindTextures(10, static_cast<GLsizei>(lines.size()), lines.data());
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, layer.block);
}

// Of a pixel [rad].
float pixel_spread(const DrawScene& scene, const TileView& view) {
    return static_cast<float>(2 * view.frame.tan_half_y / scene.camera.height);
}

void use_see(const DrawScene& scene, GLuint program, const TileView& view) {
    glUseProgram(program);
    set_rays(view, program, kTileOrigin);
    bind_environment(scene.environment, scene.rotation, program, kEnvironment);
    bind_layer(scene.gl.layer.objects());
    glUniform1f(kSpread, pixel_spread(scene, view));
    glUniform1f(kNearPlane, scene.camera.near_plane);
    glUniform1i(kSupersampling, static_cast<GLint>(scene.supersampling));
    glUniform1i(kShowsSky, scene.background ? 1 : 0);
}

// Locations of layer_smooth.frag.glsl after the first five.
enum SmoothUniform : GLint { kSmoothSamples = 5, kTolerance, kNearSuns };

void use_smooth(const DrawScene& scene, GLuint program, const TileView& view) {
    glUseProgram(program);
    set_rays(view, program, kTileOrigin);
    glUniform1i(kSmoothSamples, static_cast<GLint>(scene.supersampling));
    glUniform1f(kTolerance, kCornerTolerance);
    std::array<std::array<float, 4>, kMaxLayerSuns> suns{};  // a chord of 0 is never reached
    for (std::size_t i = 0; i < scene.layer_suns.size(); ++i) {
        const LayerSun& sun = scene.layer_suns[i];
        suns[i] = {sun.direction.x, sun.direction.y, sun.direction.z,
                   1.1f * sun.angular_radius + 2 * pixel_spread(scene, view)};
    }
    glUniform4fv(kNearSuns, static_cast<GLsizei>(suns.size()), suns.front().data());
}

// Beyond the units that `see` reads.
void bind_sheet(const SheetTextures& sheet) {
    glBindTextureUnit(8, sheet.light.name());
    glBindTextureUnit(9, sheet.through.name());
}

}  // namespace

formats::Result<LayerPrograms> make_layer_programs(GlNames& names, const LayerKind& kind,
                                                   bool sheet) {
    const std::string see = std::string(cube_map_text) + arc_tangent_text + environment_text +
                            layer_tables_text + layer_march_text + layer_see_text +
                            layers_frag_text;
    const std::string defines = define("REPEAT", kind.repeats ? 1 : 0) +
                                define("MODES", kind.modes) + define("GLOW", kind.glows ? 1 : 0) +
                                define("SHEET", sheet ? 1 : 0);
    LayerPrograms programs;
    struct Job {
        GLuint& program;
        const char *name, *fragment;
    };
    const std::array<Job, 3> jobs{{{programs.see, "cloud layer", see.c_str()},
                                   {programs.smooth, "smooth pixels", layer_smooth_frag_text},
                                   {programs.spread, "smooth samples", layer_spread_frag_text}}};
    for (const Job& job : jobs) {
        const auto program = make_program(names, job.name, defines, screen_vert_text, job.fragment);
        if (!program) return program.error();
        job.program = *program;
    }
    return programs;
}

void draw_gl_layers(const DrawScene& scene, const LayerPrograms& programs, const TileView& view,
                    const LayerTarget& target) {
    const TileGrid& grid = view.grid;
    const auto samples = static_cast<GLsizei>(scene.supersampling);
    const auto columns = static_cast<GLsizei>(grid.tile_columns);
    const auto rows = static_cast<GLsizei>(grid.tile_rows);
    const auto draw = [](const GlFramebuffer& frame, GLsizei width, GLsizei height) {
        glBindFramebuffer(GL_FRAMEBUFFER, frame.name());
        glViewport(0, 0, width, height);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    };
    use_see(scene, programs.see, view);
    glBindTextureUnit(3, 0);  // not what is drawn to
    bind_sheet({});
    glUniform1i(kSeesCorners, 1);
    draw(target.corner_frame, columns / samples + 1, rows / samples + 1);

    use_smooth(scene, programs.smooth, view);
    glBindTextureUnit(3, target.corners.name());
    bind_sheet(target.corner_sheet);
    draw(target.mean_frame, columns / samples, rows / samples);

    // The test of depth leaves out what is done before a shader runs: software renderers execute
    // both sides of a branch.
    const float left = 0;
    glClearNamedFramebufferfv(target.sample_frame.name(), GL_DEPTH, 0, &left);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glUseProgram(programs.spread);
    glUniform1i(0, samples);
    glBindTextureUnit(3, target.means.name());
    bind_sheet(target.mean_sheet);
    draw(target.sample_frame, columns, rows);

    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    glUseProgram(programs.see);
    glUniform1i(kSeesCorners, 0);
    draw(target.sample_frame, columns, rows);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace opaline::runtime
