#include "runtime/gl/gl_draw.h"

#include <array>
#include <string>
#include <utility>

#include "runtime/gl/gl_volume_pass.h"
#include "runtime/picture/picture.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

GlTexture make_target_texture(GLenum format, std::uint32_t width, std::uint32_t height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return GlTexture(name);
}

GlFramebuffer make_frame(const GlTexture& color) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, color.name(), 0);
    return GlFramebuffer(name);
}

// Lets draws to the frame write sheets too.
SheetTextures attach_sheet(const GlFramebuffer& frame, std::uint32_t width, std::uint32_t height) {
    SheetTextures sheet{make_target_texture(GL_RGBA32F, width, height),
                        make_target_texture(GL_RGBA32F, width, height)};
    constexpr std::array<GLenum, 3> kAttachments{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                                 GL_COLOR_ATTACHMENT2};
    glNamedFramebufferTexture(frame.name(), kAttachments[1], sheet.light.name(), 0);
    glNamedFramebufferTexture(frame.name(), kAttachments[2], sheet.through.name(), 0);
    glNamedFramebufferDrawBuffers(frame.name(), static_cast<GLsizei>(kAttachments.size()),
                                  kAttachments.data());
    return sheet;
}

TileGrid tile_grid(const DrawScene& scene, const Tile& tile) {
    const auto samples = [&](std::uint32_t pixels) {
        return static_cast<float>(pixels * scene.supersampling);
    };
    return {
        samples(scene.camera.width), samples(scene.camera.height), samples(tile.x), samples(tile.y),
        samples(tile.width),         samples(tile.height)};
}

// The background is drawn at the depth that the target was cleared to.
void draw_background(const DrawScene& scene, const DrawPrograms& programs, const TileView& view) {
    glDepthFunc(GL_EQUAL);
    const GLuint program = programs.background;
    glUseProgram(program);
    set_rays(view, program, 0);
    bind_environment(scene.environment, scene.rotation, program, 5);
    glBindVertexArray(programs.nothing.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void draw_pass(PicturePass pass, const DrawScene& scene, const DrawPrograms& programs,
               const TileView& view) {
    switch (pass) {
        case PicturePass::surfaces:
            return draw_surfaces(scene, programs.surfaces, view);
        case PicturePass::layers:
        case PicturePass::volumes:
            return;  // the box filter composes them, often once for a whole pixel
        case PicturePass::background:
            return draw_background(scene, programs, view);
    }
}

}  // namespace

formats::Result<DrawPrograms> make_draw_programs(const formats::AssetView& asset, GlAsset& gl) {
    DrawPrograms programs;
    auto surfaces = make_surface_programs(asset, gl);
    if (!surfaces) return surfaces.error();
    programs.surfaces = std::move(surfaces).value();
    if (gl.volumes.size() > 0) {
        const auto made = make_volume_program(gl.names, gl.volumes.objects(), false);
        if (!made) return made.error();
        programs.volumes = *made;
    }
    const auto background = make_program(
        gl.names, "background", std::string(cube_map_text) + arc_tangent_text + environment_text,
        screen_vert_text, background_frag_text);
    if (!background) return background.error();
    programs.background = *background;
    const auto resolve =
        make_program(gl.names, "box filter", "", screen_vert_text, resolve_frag_text);
    if (!resolve) return resolve.error();
    programs.resolve = *resolve;
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    programs.nothing = GlVertexArray(name);
    return programs;
}

formats::Result<DrawTarget> make_draw_target(const GlFunctions& gl, std::uint32_t width,
                                             std::uint32_t height, std::uint32_t supersampling,
                                             const DrawParts& parts) {
    const std::uint32_t columns = width * supersampling, rows = height * supersampling;
    DrawTarget target;
    target.samples = make_target_texture(GL_RGBA32F, columns, rows);
    target.depth = make_target_texture(GL_DEPTH_COMPONENT32F, columns, rows);
    target.pixels = make_target_texture(GL_RGBA32F, width, height);
    target.sample_frame = make_frame(target.samples);
    glNamedFramebufferTexture(target.sample_frame.name(), GL_DEPTH_ATTACHMENT, target.depth.name(),
                              0);
    target.pixel_frame = make_frame(target.pixels);
    if (parts.layers) {
        target.layer.corners = make_target_texture(GL_RGBA32F, width + 1, height + 1);
        target.layer.means = make_target_texture(GL_RGBA32F, width, height);
        target.layer.samples = make_target_texture(GL_RGBA32F, columns, rows);
        target.layer.is_done = make_target_texture(GL_DEPTH_COMPONENT32F, columns, rows);
        target.layer.corner_frame = make_frame(target.layer.corners);
        target.layer.mean_frame = make_frame(target.layer.means);
        target.layer.sample_frame = make_frame(target.layer.samples);
        glNamedFramebufferTexture(target.layer.sample_frame.name(), GL_DEPTH_ATTACHMENT,
                                  target.layer.is_done.name(), 0);
    }
    if (parts.layers && parts.volumes) {
        target.layer.corner_sheet = attach_sheet(target.layer.corner_frame, width + 1, height + 1);
        target.layer.mean_sheet = attach_sheet(target.layer.mean_frame, width, height);
        target.layer.sample_sheet = attach_sheet(target.layer.sample_frame, columns, rows);
    }
    const std::string doing =
        "allocating a " + std::to_string(columns) + "x" + std::to_string(rows) + " render target";
    if (const auto status = check_gl(gl, doing.c_str()); !status) {
        return status.error();
    }
    for (const GlFramebuffer* frame : {&target.sample_frame, &target.pixel_frame}) {
        if (glCheckNamedFramebufferStatus(frame->name(), GL_FRAMEBUFFER) !=
            GL_FRAMEBUFFER_COMPLETE) {
            return formats::make_error(formats::ErrorKind::resource, {}, "OpenGL",
                                       "the driver cannot render to 32-bit float textures",
                                       kRenderOnCpu);
        }
    }
    return target;
}

void draw_tile(const DrawScene& scene, const DrawPrograms& programs, const DrawTarget& target,
               const Tile& tile) {
    const TileView view{camera_frame(scene.camera), tile_grid(scene, tile)};
    glBindFramebuffer(GL_FRAMEBUFFER, target.sample_frame.name());
    glViewport(0, 0, static_cast<GLsizei>(tile.width * scene.supersampling),
               static_cast<GLsizei>(tile.height * scene.supersampling));
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    const float infinitely_far = 0.0f;
    glClearNamedFramebufferfv(target.sample_frame.name(), GL_DEPTH, 0, &infinitely_far);
    const std::array<float, 4> black{0, 0, 0, 1};
    glClearNamedFramebufferfv(target.sample_frame.name(), GL_COLOR, 0, black.data());
    const bool layers = scene.gl.layer.is_shown(), volumes = scene.gl.volumes.size() > 0;
    for (const PicturePass pass : list_passes(scene.background && !layers, volumes)) {
        draw_pass(pass, scene, programs, view);
    }

    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(programs.nothing.name());
    if (layers) {
        glBindTextureUnit(1, target.samples.name());
        glBindTextureUnit(2, target.depth.name());
        draw_gl_layers(scene, programs.layers, view, target.layer);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target.pixel_frame.name());
    glViewport(0, 0, static_cast<GLsizei>(tile.width), static_cast<GLsizei>(tile.height));
    glBindTextureUnit(0, layers ? target.layer.samples.name() : target.samples.name());
    if (volumes) {
        glBindTextureUnit(1, target.depth.name());
        if (layers) {
            glBindTextureUnit(2, target.layer.sample_sheet.light.name());
            glBindTextureUnit(3, target.layer.sample_sheet.through.name());
        }
        return draw_volumes_filtered(
            scene, layers ? programs.volumes_around_layer : programs.volumes, view);
    }
    glUseProgram(programs.resolve);
    glUniform1i(0, static_cast<GLint>(scene.supersampling));
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void read_tile(const DrawTarget& target, const Tile& tile, Picture& picture) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.pixel_frame.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(picture.width));
    glReadPixels(0, 0, static_cast<GLsizei>(tile.width), static_cast<GLsizei>(tile.height), GL_RGB,
                 GL_FLOAT, &picture.pixel[std::size_t{tile.y} * picture.width + tile.x]);
}

}  // namespace opaline::runtime
