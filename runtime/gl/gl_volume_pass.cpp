#include "runtime/gl/gl_volume_pass.h"

#include <array>
#include <string>
#include <vector>

#include "runtime/picture/volume_pass.h"
#include "runtime/volumes/suns.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of volumes.frag.glsl.
enum Uniform : GLint {
    kSupersampling,
    kTileOrigin,  // set_rays
    kNearPlane = 6,
    kSuns,
    kEyeAboveGround = kSuns + static_cast<GLint>(kMaxSuns),  // with a layer
    kUnitsOfMetre,
    kGlowColors  // where volumes have light of their own
};
static_assert(kEyeAboveGround == 15 && kGlowColors == 17);

GlBuffer upload_records(const GlVolumes& volumes, const Camera& camera) {
    const double unit = view_unit(camera);
    std::vector<ShaderVolume> records;
    for (const GlVolumes::Entry& entry : volumes.entry) {
        records.push_back(make_shader_volume(entry.lattice, entry.volume,
                                             volumes.light.part[entry.volume], camera.eye, unit));
    }
    std::size_t size = 0;
    return make_buffer_of(std::span<const ShaderVolume>(records), size);
}

void set_glow_colors(const GlVolumes& volumes, const Camera& camera) {
    std::vector<std::array<float, 4>> colors;
    for (const GlVolumes::Entry& entry : volumes.entry) {
        colors.push_back(
            shader_glow(volumes.kept.glow.view(), volumes.light, entry.volume, view_unit(camera)));
    }
    glUniform4fv(kGlowColors, static_cast<GLsizei>(colors.size()), colors.front().data());
}

}  // namespace

formats::Result<GlProgram> make_volume_program(const GlVolumes& volumes, bool layer) {
    const std::string text = std::string(volume_march_text) + harmonics_text + volumes_frag_text;
    const std::array<StageSource, 2> stages{
        {{GL_VERTEX_SHADER, screen_vert_text}, {GL_FRAGMENT_SHADER, text.c_str()}}};
    return make_program(
        "volumes",
        "#define VOLUMES " + std::to_string(volumes.entry.size()) + "\n#define HARMONICS " +
            std::to_string(volumes.harmonics) + "\n#define SUNS " + std::to_string(kMaxSuns) +
            "\n#define BRICK_WORDS " + std::to_string(kGlBrickWords) + "\n#define LAYER " +
            (layer ? "1" : "0") + "\n#define GLOW " + (volumes.glows ? "1" : "0") +
            "\n#define SHEET_TOLERANCE " + std::to_string(kSheetTolerance) + "\n",
        stages);
}

void draw_volumes_filtered(const DrawScene& scene, const GlProgram& program, const TileView& view) {
    const GlBuffer records = upload_records(scene.volumes, scene.camera);
    const std::array<const GlBuffer*, 7> buffers{&records,
                                                 &scene.volumes.table,
                                                 &scene.volumes.density,
                                                 &scene.volumes.corner,
                                                 &scene.volumes.coefficient,
                                                 &scene.volumes.phase,
                                                 &scene.volumes.glow};
    for (GLuint i = 0; i < (scene.volumes.glows ? buffers.size() : buffers.size() - 1); ++i) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]->name());
    }
    const GLuint name = program.name();
    glUseProgram(name);
    glUniform1i(kSupersampling, static_cast<GLint>(scene.supersampling));
    set_rays(view, name, kTileOrigin);
    const std::vector<formats::Vec3>& suns = scene.volumes.light.sun;
    if (!suns.empty()) glUniform3fv(kSuns, static_cast<GLsizei>(suns.size()), &suns.front().x);
    if (scene.volumes.glows) set_glow_colors(scene.volumes, scene.camera);
    glUniform1f(kNearPlane, static_cast<float>(view_unit(scene.camera) *
                                               static_cast<double>(scene.camera.near_plane)));
    if (scene.layers.shown) {
        const double height =
            static_cast<double>(scene.camera.eye.y) - scene.layers.places.ground_height;
        const double unit = view_unit(scene.camera);
        glUniform1f(kEyeAboveGround, static_cast<float>(unit * height));
        glUniform1f(kUnitsOfMetre, static_cast<float>(unit));
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace opaline::runtime
