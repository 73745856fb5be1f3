#include "runtime/gl/gl_volume_pass.h"

#include <array>
#include <string>

#include "runtime/gl/gl_objects.h"
#include "runtime/picture/volume_pass.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/suns.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

using formats::TermSet;

TermSet of_volumes(TermSet terms) {
    return terms & (TermSet::volume_single | TermSet::volume_multiple);
}

// Locations of volumes.frag.glsl.
enum Uniform : GLint {
    kSupersampling,
    kTileOrigin,  // set_rays
    kNearPlane = 6,
    kEyeAboveGround = 15,  // with a layer
    kUnitsOfMetre
};

}  // namespace

formats::Status relight_gl_volumes(GlVolumeLight& lit, VolumeTextures& textures,
                                   const LightVector& light, const EmitterLight& emitters) {
    if (textures.size() == 0) return formats::ok_status();
    lit.light = light;
    lit.emitters.assign(emitters.color.begin(), emitters.color.end());
    lit.shows_own = emitters.shows_own;
    lit.terms = TermSet::none;
    return show_volume_terms(lit, textures, TermSet::all);
}

formats::Status show_volume_terms(GlVolumeLight& lit, VolumeTextures& textures, TermSet terms) {
    if (textures.size() == 0 || lit.terms == of_volumes(terms)) return formats::ok_status();
    lit.terms = of_volumes(terms);
    if (lit.light.n == 0) return formats::ok_status();  // uploaded without light
    return as_status(textures.upload(relight_volumes(
        lit.volumes, lit.light, {.terms = lit.terms, .emitters = {lit.emitters, lit.shows_own}})));
}

formats::Result<GLuint> make_volume_program(GlNames& names, const opaline_gl_volumes& volumes,
                                            bool layer) {
    const std::string text = std::string(volume_march_text) + harmonics_text + volumes_frag_text;
    const std::string defines = define("RECORDS_IN_BLOCK") + define("VOLUMES", volumes.count) +
                                define("HARMONICS", volumes.terms) + define("SUNS", kMaxSuns) +
                                define("BRICK_WORDS", kGlBrickWords) +
                                define("LAYER", layer ? 1 : 0) + define("GLOW", volumes.glows) +
                                define("SHEET_TOLERANCE", std::to_string(kSheetTolerance));
    return make_program(names, "volumes", defines, screen_vert_text, text.c_str());
}

void draw_volumes_filtered(const DrawScene& scene, GLuint program, const TileView& view) {
    const opaline_gl_volumes& volumes = scene.gl.volumes.objects();
    const std::array<GLuint, 6> textures{volumes.brick_numbers,  volumes.density_codes,
                                         volumes.corner_numbers, volumes.node_light,
                                         volumes.phase_entries,  volumes.glow_words};
    glBindTextures(4, static_cast<GLsizei>(textures.size()), textures.data());
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, volumes.block);
    glUseProgram(program);
    glUniform1i(kSupersampling, static_cast<GLint>(scene.supersampling));
    set_rays(view, program, kTileOrigin);
    glUniform1f(kNearPlane, static_cast<float>(view_unit(scene.camera) *
                                               static_cast<double>(scene.camera.near_plane)));
    if (scene.gl.layer.is_shown()) {
        const double height =
            static_cast<double>(scene.camera.eye.y) - scene.gl.layer.places().ground_height;
        const double unit = view_unit(scene.camera);
        glUniform1f(kEyeAboveGround, static_cast<float>(unit * height));
        glUniform1f(kUnitsOfMetre, static_cast<float>(unit));
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace opaline::runtime
