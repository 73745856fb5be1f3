#include "runtime/gl/gl_draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "shader_text.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

// What a surface's program has to do.
struct SurfaceKind {
    bool is_textured = false, is_translucent = false, is_glossy = false;

    std::size_t number() const {  // in DrawPrograms
        return (is_textured ? 1u : 0u) + (is_glossy ? 4u : is_translucent ? 2u : 0u);
    }
};

SurfaceKind surface_kind(const GlAsset& asset, std::size_t primitive) {
    const formats::PrimitiveRecord& record = asset.primitives[primitive];
    return {record.base_color_image < asset.images.size(),
            record.shading == formats::Shading::translucent,
            !asset.roughness.empty() && asset.roughness[primitive] >= 0};
}

// Whether the wanted components include those of its single row; several rows are added up as
// wanted already.
bool is_shown(const formats::PrimitiveRecord& primitive, std::uint32_t terms) {
    const std::uint32_t held = primitive.shading != formats::Shading::translucent ? kDiffuseTerm
                               : needs_view(primitive)                            ? 0
                               : primitive.is_separate()                          ? kMultipleTerm
                                                         : kMultipleTerm | kSingleTerm;
    return (terms & held) == held;
}

void set_vec3(GLuint program, GLint location, Vec3 v) {
    glProgramUniform3f(program, location, v.x, v.y, v.z);
}

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

struct TileGrid {
    float columns = 0, rows = 0;            ///< samples of the whole picture
    float first_column = 0, first_row = 0;  ///< of the tile
    float tile_columns = 0, tile_rows = 0;
};

TileGrid tile_grid(const DrawScene& scene, const Tile& tile) {
    const auto samples = [&](std::uint32_t pixels) {
        return static_cast<float>(pixels * scene.supersampling);
    };
    return {
        samples(scene.camera.width), samples(scene.camera.height), samples(tile.x), samples(tile.y),
        samples(tile.width),         samples(tile.height)};
}

void set_view(const DrawScene& scene, const CameraFrame& frame, const TileGrid& grid,
              GLuint program) {
    const Camera& camera = scene.camera;
    const double unit = view_unit(camera);
    set_vec3(program, 0, camera.eye);
    set_vec3(program, 1, static_cast<float>(1.0 / frame.tan_half_x) * frame.right);
    set_vec3(program, 2, static_cast<float>(-1.0 / frame.tan_half_y) * frame.up);
    set_vec3(program, 3, -1.0f * frame.backward);
    glProgramUniform1f(program, 4, static_cast<float>(unit));
    glProgramUniform1f(program, 5,
                       static_cast<float>(unit * static_cast<double>(camera.near_plane)));
    const float scale_x = grid.columns / grid.tile_columns, scale_y = grid.rows / grid.tile_rows;
    glProgramUniform4f(program, 6, scale_x, scale_y,
                       scale_x - 2.0f * grid.first_column / grid.tile_columns - 1.0f,
                       scale_y - 2.0f * grid.first_row / grid.tile_rows - 1.0f);
}

void set_light_from_world(const DrawScene& scene, GLuint program, GLint location) {
    // Rows are the light's axes, so that the product is light_from_world.
    const Rotation& r = scene.rotation;
    const std::array<float, 9> rows{r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z};
    glProgramUniformMatrix3fv(program, location, 1, GL_TRUE, rows.data());
}

void set_gloss(const DrawScene& scene, GLuint program, std::size_t primitive) {
    const SpecularLight& light = scene.specular.light;
    formats::AssetView asset;  // as much of it as a lobe depends on
    asset.roughness = scene.asset.roughness;
    const SpecularLobe lobe = specular_lobe(light, asset, primitive);
    const bool shows = lobe.radiance != nullptr && (scene.terms & kSpecularTerm) != 0;
    set_light_from_world(scene, program, 12);
    glProgramUniform2f(program, 13, lobe.cosine, lobe.sine);
    glProgramUniform1ui(program, 14, shows ? 1u : 0u);
    for (std::size_t i = 0; i < light.maps.size(); ++i) {
        if (&light.maps[i].radiance == lobe.radiance) {
            glBindTextureUnit(1, scene.specular.texture[i].name());
        }
    }
}

void draw_surfaces(const DrawScene& scene, const DrawPrograms& programs, const CameraFrame& frame,
                   const TileGrid& grid) {
    const GlAsset& asset = scene.asset;
    for (const GlProgram& program : programs.surface) {
        if (program.name() != 0) set_view(scene, frame, grid, program.name());
    }
    glBindVertexArray(asset.vertex_array.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, asset.srgb_table.name());
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const SurfaceKind kind = surface_kind(asset, p);
        const GLuint program = programs.surface[kind.number()].name();
        glUseProgram(program);
        if (kind.is_textured) {
            glUniform2i(8, static_cast<GLint>(primitive.wrap_u),
                        static_cast<GLint>(primitive.wrap_v));
            glBindTextureUnit(0, asset.images[primitive.base_color_image].name());
        }
        if (kind.is_translucent) {
            glUniform1f(9, primitive.eta);
            glUniform1ui(10, primitive.flags & formats::PrimitiveRecord::kDoubleSided);
        }
        glUniform1f(11, is_shown(primitive, scene.terms) ? 1.0f : 0.0f);
        if (kind.is_glossy) set_gloss(scene, program, p);
        // In pieces that a signed count holds; each a whole number of triangles.
        constexpr std::uint32_t kPiece = 3u << 28;
        for (std::uint32_t at = 0; at < primitive.index_count; at += kPiece) {
            const std::size_t first = std::size_t{primitive.first_index} + at;
            glDrawElementsBaseVertex(
                GL_TRIANGLES, static_cast<GLsizei>(std::min(kPiece, primitive.index_count - at)),
                GL_UNSIGNED_INT, reinterpret_cast<const void*>(first * sizeof(std::uint32_t)),
                static_cast<GLint>(primitive.first_vertex));
        }
    }
}

void draw_background(const DrawScene& scene, const DrawPrograms& programs, const CameraFrame& frame,
                     const TileGrid& grid) {
    const GlEnvironment& environment = scene.environment;
    const GLuint program = programs.background.name();
    glUseProgram(program);
    glUniform2f(0, grid.first_column, grid.first_row);
    glUniform2f(1, 2.0f / grid.columns, 2.0f / grid.rows);
    set_vec3(program, 2, static_cast<float>(frame.tan_half_x) * frame.right);
    set_vec3(program, 3, static_cast<float>(-frame.tan_half_y) * frame.up);
    set_vec3(program, 4, -1.0f * frame.backward);
    set_light_from_world(scene, program, 5);
    glUniform1i(6, static_cast<GLint>(environment.map));
    glUniform2f(7, environment.u_offset, environment.u_sign);
    glUniform1i(8, environment.rows_include_poles ? 1 : 0);
    glUniform1i(9, environment.disc_count);
    glBindTextureUnit(0, environment.texture.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, environment.discs.name());
    glBindVertexArray(programs.nothing.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

double view_unit(const Camera& camera) {
    const Vec3 to_target = camera.target - camera.eye;
    const double distance =
        std::hypot(static_cast<double>(to_target.x), static_cast<double>(to_target.y),
                   static_cast<double>(to_target.z));
    return 1.0 / std::max(distance, static_cast<double>(camera.near_plane));
}

formats::Result<DrawPrograms> make_draw_programs(const GlAsset& asset) {
    DrawPrograms programs;
    const std::string wraps = "#define TEXTURED\n#define WRAP_CLAMP " +
                              std::to_string(static_cast<int>(formats::Wrap::clamp)) +
                              "\n#define WRAP_MIRROR " +
                              std::to_string(static_cast<int>(formats::Wrap::mirror)) + "\n";
    struct Job {
        GlProgram& program;
        const char* name;
        std::string defines;
        const char *vertex, *fragment;
    };
    std::vector<Job> jobs{
        {programs.background, "background", cube_map_text, screen_vert_text, background_frag_text},
        {programs.resolve, "box filter", "", screen_vert_text, resolve_frag_text}};
    std::array<bool, 6> is_made{};
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const SurfaceKind kind = surface_kind(asset, p);
        if (std::exchange(is_made[kind.number()], true)) continue;
        std::string defines = kind.is_textured ? wraps : std::string();
        if (kind.is_translucent) defines += "#define TRANSLUCENT\n";
        if (kind.is_glossy) defines += std::string("#define GLOSSY\n") + cube_map_text;
        jobs.push_back({programs.surface[kind.number()], "surface", std::move(defines),
                        surface_vert_text, surface_frag_text});
    }
    for (const Job& job : jobs) {
        const std::array<StageSource, 2> stages{
            {{GL_VERTEX_SHADER, job.vertex}, {GL_FRAGMENT_SHADER, job.fragment}}};
        auto program = make_program(job.name, job.defines, stages);
        if (!program) return program.error();
        job.program = std::move(program).value();
    }
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    programs.nothing = GlVertexArray(name);
    return programs;
}

formats::Result<DrawTarget> make_draw_target(std::uint32_t width, std::uint32_t height,
                                             std::uint32_t supersampling) {
    const std::uint32_t columns = width * supersampling, rows = height * supersampling;
    DrawTarget target;
    target.samples = make_target_texture(GL_RGBA32F, columns, rows);
    target.depth = make_target_texture(GL_DEPTH_COMPONENT32F, columns, rows);
    target.pixels = make_target_texture(GL_RGBA32F, width, height);
    target.sample_frame = make_frame(target.samples);
    glNamedFramebufferTexture(target.sample_frame.name(), GL_DEPTH_ATTACHMENT, target.depth.name(),
                              0);
    target.pixel_frame = make_frame(target.pixels);
    if (const auto status = check_gl("allocating a " + std::to_string(columns) + "x" +
                                     std::to_string(rows) + " render target");
        !status) {
        return status.error();
    }
    for (const GlFramebuffer* frame : {&target.sample_frame, &target.pixel_frame}) {
        if (glCheckNamedFramebufferStatus(frame->name(), GL_FRAMEBUFFER) !=
            GL_FRAMEBUFFER_COMPLETE) {
            return formats::make_error(formats::ErrorKind::resource, {}, "OpenGL",
                                       "the driver cannot render to 32-bit float textures",
                                       "render on the CPU");
        }
    }
    return target;
}

void draw_tile(const DrawScene& scene, const DrawPrograms& programs, const DrawTarget& target,
               const Tile& tile) {
    const CameraFrame frame = camera_frame(scene.camera);
    const TileGrid grid = tile_grid(scene, tile);
    glBindFramebuffer(GL_FRAMEBUFFER, target.sample_frame.name());
    glViewport(0, 0, static_cast<GLsizei>(tile.width * scene.supersampling),
               static_cast<GLsizei>(tile.height * scene.supersampling));
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    const float infinitely_far = 0.0f;
    glClearNamedFramebufferfv(target.sample_frame.name(), GL_DEPTH, 0, &infinitely_far);
    if (!scene.background) {
        const std::array<float, 4> black{0, 0, 0, 1};
        glClearNamedFramebufferfv(target.sample_frame.name(), GL_COLOR, 0, black.data());
    }
    glDepthFunc(GL_GREATER);
    draw_surfaces(scene, programs, frame, grid);
    glDepthFunc(GL_EQUAL);  // the background is drawn at the depth that the target was cleared to
    if (scene.background) {
        draw_background(scene, programs, frame, grid);
    }

    glBindFramebuffer(GL_FRAMEBUFFER, target.pixel_frame.name());
    glViewport(0, 0, static_cast<GLsizei>(tile.width), static_cast<GLsizei>(tile.height));
    glDisable(GL_DEPTH_TEST);
    glUseProgram(programs.resolve.name());
    glUniform1i(0, static_cast<GLint>(scene.supersampling));
    glBindTextureUnit(0, target.samples.name());
    glBindVertexArray(programs.nothing.name());
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
