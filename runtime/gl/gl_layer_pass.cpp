#include "runtime/gl/gl_layer_pass.h"

#include <array>
#include <string>
#include <utility>

#include "runtime/picture/layer_pass.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of layers.frag.glsl, and of what comes before it; 5 to 9 are the environment's.
enum Uniform : GLint {
    kTileOrigin = 0,  // set_rays
    kEnvironment = 5,
    kFieldOrigin = 10,
    kEyeAboveBase,
    kSpread,
    kAlbedoOrigin,
    kLightOrigin,
    kEyeAboveGround,
    kNearPlane,
    kSupersampling,
    kSeesCorners,
    kShowsSky
};

// Where the eye is.
void set_origin(GLint location, const LayerGrid& grid, formats::Vec3 eye) {
    const std::array<float, 2> place = grid.place_of(eye);
    glUniform2f(location, place[0], place[1]);
}

void bind_layer(const DrawScene& scene) {
    const GlLayers& layers = scene.layers;
    const std::array<const GlTexture*, 3> textures{&layers.albedo, &layers.ground_light,
                                                   &layers.base_light};
    for (GLuint i = 0; i < textures.size(); ++i) {
        glBindTextureUnit(5 + i, textures[i]->name());
    }
    const std::array<const GlBuffer*, 7> buffers{
        &layers.block,      &layers.phase,    &layers.flux,     &layers.glow,
        &layers.sun_tables, &layers.sun_flux, &layers.thickness};
    for (GLuint i = 0; i < buffers.size(); ++i) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1 + i, buffers[i]->name());
    }
}

// Of a pixel [rad].
float pixel_spread(const DrawScene& scene, const TileView& view) {
    return static_cast<float>(2 * view.frame.tan_half_y / scene.camera.height);
}

void use_see(const DrawScene& scene, const GlProgram& program, const TileView& view) {
    const GlLayers& layers = scene.layers;
    const Camera& camera = scene.camera;
    glUseProgram(program.name());
    set_rays(view, program.name(), kTileOrigin);
    bind_environment(scene.environment, scene.rotation, program.name(), kEnvironment);
    bind_layer(scene);
    set_origin(kFieldOrigin, layers.places.field, camera.eye);
    set_origin(kAlbedoOrigin, layers.places.ground, camera.eye);
    set_origin(kLightOrigin, layers.places.light, camera.eye);
    const double height = static_cast<double>(camera.eye.y);
    glUniform1f(kEyeAboveBase, static_cast<float>(height - layers.places.base));
    glUniform1f(kEyeAboveGround, static_cast<float>(height - layers.places.ground_height));
    glUniform1f(kSpread, pixel_spread(scene, view));
    glUniform1f(kNearPlane, camera.near_plane);
    glUniform1i(kSupersampling, static_cast<GLint>(scene.supersampling));
    glUniform1i(kShowsSky, scene.background ? 1 : 0);
}

// Locations of layer_smooth.frag.glsl after the first five.
enum SmoothUniform : GLint { kSmoothSamples = 5, kTolerance, kNearSuns };

void use_smooth(const DrawScene& scene, const GlProgram& program, const TileView& view) {
    glUseProgram(program.name());
    set_rays(view, program.name(), kTileOrigin);
    glUniform1i(kSmoothSamples, static_cast<GLint>(scene.supersampling));
    glUniform1f(kTolerance, kCornerTolerance);
    std::array<std::array<float, 4>, kMaxLayerSuns> suns{};  // a chord of 0 is never reached
    for (std::size_t i = 0; i < scene.layers.suns.size(); ++i) {
        const LayerSun& sun = scene.layers.suns[i];
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

formats::Result<LayerPrograms> make_layer_programs(const GlLayers& layers, bool sheet) {
    const std::string see = std::string(cube_map_text) + arc_tangent_text + environment_text +
                            layer_tables_text + layer_march_text + layer_see_text +
                            layers_frag_text;
    const std::string defines = layers.defines + "#define SHEET " + (sheet ? "1\n" : "0\n");
    LayerPrograms programs;
    struct Job {
        GlProgram& program;
        const char *name, *fragment;
    };
    const std::array<Job, 3> jobs{{{programs.see, "cloud layer", see.c_str()},
                                   {programs.smooth, "smooth pixels", layer_smooth_frag_text},
                                   {programs.spread, "smooth samples", layer_spread_frag_text}}};
    for (const Job& job : jobs) {
        const std::array<StageSource, 2> stages{
            {{GL_VERTEX_SHADER, screen_vert_text}, {GL_FRAGMENT_SHADER, job.fragment}}};
        auto program = make_program(job.name, defines, stages);
        if (!program) return program.error();
        job.program = std::move(program).value();
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
    glUseProgram(programs.spread.name());
    glUniform1i(0, samples);
    glBindTextureUnit(3, target.means.name());
    bind_sheet(target.mean_sheet);
    draw(target.sample_frame, columns, rows);

    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    glUseProgram(programs.see.name());
    glUniform1i(kSeesCorners, 0);
    draw(target.sample_frame, columns, rows);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace opaline::runtime
