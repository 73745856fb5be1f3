#include "runtime/gl/gl_surfaces.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <string>

#include "formats/opal/ggx_albedo.h"
#include "runtime/gloss.h"
#include "runtime/volumes/suns.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

using formats::TermSet;

// Locations of surface.vert.glsl, surface.frag.glsl and gloss.glsl.
enum Uniform : GLint {
    kEye,
    kRight,
    kDown,
    kForward,
    kUnit,
    kNearPlane,
    kTile,
    kWrap = 8,
    kEta,
    kIsDoubleSided,
    kShown,
    kLightFromWorld,
    kLobe,
    kHasSpecular,
    kF0F90,
    kMetallicRoughness,
    kGlossWrap,
    kOwnLight = 19,
    kOwnWrap,
    kHole,
    kFirstSample,
    kHoleWrap,
    kNormalWrap,
    kNormalScale,
    kTurnedLight,  // as many as opaline_turn_light's struct has vectors
    kTurnedLeast = kTurnedLight + 9,
    kTurnedSuns,
    kTurnedSunDirection,
    kTurnedSunLight = kTurnedSunDirection + static_cast<GLint>(kMaxSuns),
    kHoleClear = kTurnedSunLight + static_cast<GLint>(kMaxSuns)
};

// What a surface's program has to do: each a bit of its number, and a #define of its shaders.
enum Trait : std::size_t {
    kTextured,
    kTranslucent,
    kMirroring,  // translucent and glossy
    kGlossy,     // opaque
    kGlossImage,
    kOwnImage,
    kGlows,     // sends out light by itself
    kHasHoles,  // light passes it in places
    kHoleImage,
    kNormalMapped,
    kTurned,    // and its light is
    kTwoSided,  // turned light of a thin-walled surface
    kClear,     // as glass
    kTraits
};
constexpr std::array<const char*, kTraits> kTraitDefines{
    "TEXTURED", "TRANSLUCENT", "MIRRORING",  "GLOSS",  "GLOSS_TEXTURED", "OWN_TEXTURED", "GLOWS",
    "HOLES",    "HOLE_IMAGE",  "NORMAL_MAP", "TURNED", "TWO_SIDES",      "CLEAR_HOLE"};
using SurfaceKind = std::bitset<kTraits>;

bool has_image(SurfaceKind kind) {
    return kind[kTextured] || kind[kGlossImage] || kind[kOwnImage] || kind[kHoleImage] ||
           kind[kNormalMapped];
}

SurfaceKind surface_kind(const formats::AssetView& asset, const GlAsset& gl, std::uint32_t p) {
    const formats::PrimitiveRecord& record = asset.primitives[p];
    const opaline_gl_images images = gl.images.of(p);
    SurfaceKind kind;
    kind[kTextured] = images.base_color.texture != 0;
    kind[kTranslucent] = record.shading == formats::Shading::translucent;
    kind[kMirroring] = gl.mirrored.lobe_of(p).texture != 0;
    kind[kGlossy] = !gl.gloss.empty() && gl.gloss[p].is_glossy();
    kind[kGlossImage] = images.gloss.texture != 0;
    kind[kGlows] = asset.emitters.own_of(p) != nullptr;
    kind[kOwnImage] = images.emission.texture != 0;
    if (const formats::HoleRecord* const hole = asset.holes.of(p)) {
        kind[kHasHoles] = true;
        kind[kClear] = hole->clear != 0;
        kind[kHoleImage] = images.alpha.texture != 0;
    }
    if (const opaline_gl_normal_map map = gl.images.normal_map_of(p); map.image.texture != 0) {
        kind[kNormalMapped] = true;
        kind[kTwoSided] = map.is_turned == 2;
        kind[kTurned] = map.is_turned != 0;
    }
    return kind;
}

bool has_view(SurfaceKind kind) {
    return kind[kTranslucent] || kind[kGlossy] || kind[kNormalMapped] || kind[kClear];
}

std::string defines_of(SurfaceKind kind, bool has_vertex_alpha) {
    std::string text;
    for (std::size_t i = 0; i < kTraits; ++i) {
        if (kind[i]) text += define(kTraitDefines[i]);
    }
    if (kind[kHasHoles] && has_vertex_alpha) text += define("HOLE_VERTICES");
    if (has_image(kind)) text += define("HAS_TEXCOORD");
    if (has_view(kind)) text += define("HAS_VIEW");
    if (kind[kMirroring] || kind[kGlossy]) text += define("HAS_OPENNESS");
    return text;
}

// The fragment shader with what it includes.
std::string fragment_text(SurfaceKind kind) {
    std::string text;
    if (has_image(kind)) {
        text += define("WRAP_CLAMP", static_cast<std::size_t>(formats::Wrap::clamp)) +
                define("WRAP_MIRROR", static_cast<std::size_t>(formats::Wrap::mirror)) +
                define("WRAP_NEAREST", formats::kNearestBit) + image_text;
    }
    text += cube_map_text;
    text += surface_text;
    if (kind[kGlossy]) {
        text += define("LOBE_TAPS", kLobeTaps) + define("ALBEDO_ROWS", formats::kAlbedoRows) +
                define("ALBEDO_COLUMNS", formats::kAlbedoColumns) +
                define("NARROW_ROUGHNESS", std::to_string(kNarrowRoughness)) +
                define("WIDE_ROUGHNESS", std::to_string(kWideRoughness)) + gloss_text;
    }
    if (kind[kHasHoles]) text += std::string(covers_text) + holes_text;
    return text + surface_frag_text;
}

// Whether the wanted components include those of its single row; several rows are added up as
// wanted already.
bool is_shown(const formats::PrimitiveRecord& primitive, TermSet terms) {
    const TermSet held = primitive.shading != formats::Shading::translucent ? TermSet::diffuse
                         : needs_view(primitive)                            ? TermSet::none
                         : primitive.is_separate()                          ? TermSet::multiple
                         : primitive.is_single_only()                       ? TermSet::single
                                                      : TermSet::multiple | TermSet::single;
    return has_all(terms, held);
}

void set_view(const DrawScene& scene, const TileView& view, GLuint program) {
    const Camera& camera = scene.camera;
    const CameraFrame& frame = view.frame;
    const TileGrid& grid = view.grid;
    const double unit = view_unit(camera);
    set_vec3(program, kEye, camera.eye);
    set_vec3(program, kRight, static_cast<float>(1.0 / frame.tan_half_x) * frame.right);
    set_vec3(program, kDown, static_cast<float>(-1.0 / frame.tan_half_y) * frame.up);
    set_vec3(program, kForward, -1.0f * frame.backward);
    glProgramUniform1f(program, kUnit, static_cast<float>(unit));
    glProgramUniform1f(program, kNearPlane,
                       static_cast<float>(unit * static_cast<double>(camera.near_plane)));
    const float scale_x = grid.columns / grid.tile_columns, scale_y = grid.rows / grid.tile_rows;
    glProgramUniform4f(program, kTile, scale_x, scale_y,
                       scale_x - 2.0f * grid.first_column / grid.tile_columns - 1.0f,
                       scale_y - 2.0f * grid.first_row / grid.tile_rows - 1.0f);
}

void set_mirroring(const DrawScene& scene, GLuint program, std::uint32_t primitive) {
    const MirroredLight::Lobe lobe = scene.gl.mirrored.lobe_of(primitive);
    set_light_from_world(scene.gl.mirrored.rotation(), program, kLightFromWorld);
    glProgramUniform2f(program, kLobe, lobe.cosine, lobe.sine);
    glProgramUniform1ui(program, kHasSpecular, has_any(scene.terms, TermSet::specular) ? 1u : 0u);
    glBindTextureUnit(1, lobe.texture);
}

// Nothing where there is none.
void bind_image(GLuint unit, GLuint program, GLint location, const opaline_gl_image& image) {
    if (image.texture == 0) return;
    glBindTextureUnit(unit, image.texture);
    glProgramUniform2iv(program, location, 1, image.wrap);
}

void set_gloss(const DrawScene& scene, GLuint program, const formats::GlossRecord& gloss) {
    set_light_from_world(scene.gl.mirrored.rotation(), program, kLightFromWorld);
    glProgramUniform1ui(program, kHasSpecular, has_any(scene.terms, TermSet::specular) ? 1u : 0u);
    glProgramUniform4f(program, kF0F90, gloss.f0.r, gloss.f0.g, gloss.f0.b, gloss.f90);
    glProgramUniform2f(program, kMetallicRoughness, gloss.metallic, gloss.roughness);
    const opaline_gl_objects& objects = scene.gl.objects;
    glBindTextureUnit(2, objects.light_maps);
    const std::array<GLuint, 3> tables{objects.cells, objects.sun_table, objects.albedo};
    glBindTextures(8, static_cast<GLsizei>(tables.size()), tables.data());
}

void set_own_light(const DrawScene& scene, GLuint program, std::uint32_t primitive) {
    const formats::Rgb own = scene.own.empty() ? formats::Rgb{} : scene.own[primitive];
    set_vec3(program, kOwnLight, {own.r, own.g, own.b});
}

void set_hole(const TileGrid& grid, GLuint program, const formats::HoleRecord& hole) {
    glProgramUniform3f(program, kHole, hole.alpha, hole.cutoff, static_cast<float>(hole.mode));
    glProgramUniform2ui(program, kFirstSample, static_cast<GLuint>(grid.first_column),
                        static_cast<GLuint>(grid.first_row));
    if (hole.clear != 0) {
        const formats::ClearShare clear = formats::clear_share_of(hole);
        glProgramUniform2f(program, kHoleClear, clear.share, clear.eta);
    }
}

void set_normal_map(GLuint program, const opaline_gl_normal_map& map) {
    bind_image(6, program, kNormalWrap, map.image);
    glProgramUniform1f(program, kNormalScale, map.scale);
    if (map.is_turned == 0) return;
    const auto set = [&](GLint location, GLsizei count, const float* values) {
        glProgramUniform3fv(program, location, count, values);
    };
    set(kTurnedLight, 9, map.harmonics[0]);
    set(kTurnedLeast, 1, map.least);
    glProgramUniform1i(program, kTurnedSuns, map.suns);
    if (map.suns == 0) return;
    set(kTurnedSunDirection, map.suns, map.sun_direction[0]);
    set(kTurnedSunLight, map.suns, map.sun_light[0]);
}

void draw_triangles(const formats::PrimitiveRecord& primitive) {
    // In pieces that a signed count holds; each a whole number of triangles.
    constexpr std::uint32_t kPiece = 3u << 28;
    for (std::uint32_t at = 0; at < primitive.index_count; at += kPiece) {
        const std::size_t first = std::size_t{primitive.first_index} + at;
        // NOLINTBEGIN(performance-no-int-to-ptr): an offset into the buffer, which GL takes so.
        glDrawElementsBaseVertex(
            GL_TRIANGLES, static_cast<GLsizei>(std::min(kPiece, primitive.index_count - at)),
            GL_UNSIGNED_INT, reinterpret_cast<const void*>(first * sizeof(std::uint32_t)),
            static_cast<GLint>(primitive.first_vertex));
        // NOLINTEND(performance-no-int-to-ptr)
    }
}

void bind_attribute(GLuint array, GLuint attribute, GLuint buffer, GLint numbers, GLenum type,
                    GLsizei stride, GLuint offset = 0) {
    if (buffer == 0) return;
    glVertexArrayVertexBuffer(array, attribute, buffer, 0, stride);
    glVertexArrayAttribFormat(array, attribute, numbers, type, type != GL_FLOAT, offset);
    glVertexArrayAttribBinding(array, attribute, attribute);
    glEnableVertexArrayAttrib(array, attribute);
}

// Integers are scaled to [-1, 1] or [0, 1] on the way.
GlVertexArray make_vertex_array(const GlAsset& gl, bool has_openness) {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    const opaline_gl_objects& objects = gl.objects;
    bind_attribute(name, 0, objects.position, 3, GL_FLOAT, sizeof(formats::Vec3));
    bind_attribute(name, 1, objects.radiance, 3, GL_FLOAT, kRadianceBytes);
    bind_attribute(name, 2, objects.base_color, 3, GL_FLOAT, sizeof(formats::Rgb));
    bind_attribute(name, 3, objects.texcoord, 2, GL_FLOAT, sizeof(formats::Float2));
    bind_attribute(name, 4, objects.normal, 3, GL_FLOAT, sizeof(formats::Vec3));
    if (has_openness) {  // the octahedral axis, and the fraction
        constexpr GLsizei kStride = sizeof(formats::Openness);
        bind_attribute(name, 5, objects.openness, 2, GL_BYTE, kStride);
        bind_attribute(name, 6, objects.openness, 1, GL_UNSIGNED_BYTE, kStride,
                       offsetof(formats::Openness, fraction));
    }
    bind_attribute(name, 7, gl.images.vertex_alpha(), 1, GL_FLOAT, sizeof(float));
    bind_attribute(name, 8, gl.images.tangent(), 3, GL_SHORT, sizeof(formats::Tangent));
    glVertexArrayElementBuffer(name, objects.triangle);
    return GlVertexArray(name);
}

}  // namespace

formats::Result<SurfacePrograms> make_surface_programs(const formats::AssetView& asset,
                                                       GlAsset& gl) {
    SurfacePrograms programs;
    const std::string vertex = std::string(openness_text) + surface_vert_text;
    bool has_openness = false;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const SurfaceKind kind = surface_kind(asset, gl, p);
        has_openness = has_openness || kind[kMirroring] || kind[kGlossy];
        GLuint& program = programs.program[kind.to_ulong()];
        if (program != 0) continue;
        const std::string fragment = fragment_text(kind);
        const auto made =
            make_program(gl.names, "surface", defines_of(kind, gl.images.vertex_alpha() != 0),
                         vertex.c_str(), fragment.c_str());
        if (!made) return made.error();
        program = *made;
    }
    programs.vertices = make_vertex_array(gl, has_openness);
    return programs;
}

void draw_surfaces(const DrawScene& scene, const SurfacePrograms& programs, const TileView& view) {
    const formats::AssetView& asset = scene.asset;
    for (const auto& [kind, program] : programs.program) {
        set_view(scene, view, program);
    }
    glDepthFunc(GL_GREATER);
    glBindVertexArray(programs.vertices.name());
    glBindTextureUnit(7, scene.gl.images.srgb_table());
    glFrontFace(GL_CW);  // y points down
    glCullFace(GL_BACK);
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const SurfaceKind kind = surface_kind(asset, scene.gl, p);
        const opaline_gl_images images = scene.gl.images.of(p);
        (primitive.shows_back() ? glDisable : glEnable)(GL_CULL_FACE);
        const GLuint program = programs.program.at(kind.to_ulong());
        glUseProgram(program);
        bind_image(0, program, kWrap, images.base_color);
        bind_image(3, program, kGlossWrap, images.gloss);
        bind_image(4, program, kOwnWrap, images.emission);
        bind_image(5, program, kHoleWrap, images.alpha);
        if (kind[kTranslucent]) glUniform1f(kEta, primitive.eta);
        if (has_view(kind)) {
            glUniform1ui(kIsDoubleSided, primitive.flags & formats::PrimitiveRecord::kDoubleSided);
        }
        glUniform1f(kShown, is_shown(primitive, scene.terms) ? 1.0f : 0.0f);
        if (kind[kMirroring]) set_mirroring(scene, program, p);
        if (kind[kGlossy]) set_gloss(scene, program, scene.gl.gloss[p]);
        if (kind[kHasHoles]) set_hole(view.grid, program, *asset.holes.of(p));
        if (kind[kNormalMapped]) set_normal_map(program, scene.gl.images.normal_map_of(p));
        if (kind[kGlows]) set_own_light(scene, program, p);
        draw_triangles(primitive);
    }
    glDisable(GL_CULL_FACE);
}

}  // namespace opaline::runtime
