#include "runtime/gl/gl_surfaces.h"

#include <algorithm>
#include <bitset>
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
    kSuns,
    kOwnLight,
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

const formats::OwnLight* own_light_of(const GlAsset& asset, std::size_t primitive) {
    return asset.emitters.view().own_of(static_cast<std::uint32_t>(primitive));
}

const formats::HoleRecord* hole_of(const GlAsset& asset, std::size_t primitive) {
    return formats::HolesView{asset.holes, {}}.of(static_cast<std::uint32_t>(primitive));
}

const formats::NormalMapRecord* normal_map_of(const GlAsset& asset, std::size_t primitive) {
    return formats::NormalMapsView{asset.normal_maps, {}}.of(static_cast<std::uint32_t>(primitive));
}

SurfaceKind surface_kind(const GlAsset& asset, std::size_t primitive) {
    const formats::PrimitiveRecord& record = asset.primitives[primitive];
    const auto is_image = [&](std::uint32_t number) { return number < asset.images.size(); };
    SurfaceKind kind;
    kind[kTextured] = is_image(record.base_color_image);
    kind[kTranslucent] = record.shading == formats::Shading::translucent;
    kind[kMirroring] = !asset.roughness.empty() && asset.roughness[primitive] >= 0;
    kind[kGlossy] = !asset.gloss.empty() && asset.gloss[primitive].is_glossy();
    kind[kGlossImage] = kind[kGlossy] && is_image(asset.gloss[primitive].image);
    if (const formats::OwnLight* const own = own_light_of(asset, primitive)) {
        kind[kGlows] = true;
        kind[kOwnImage] = is_image(own->image);
    }
    if (const formats::HoleRecord* const hole = hole_of(asset, primitive)) {
        kind[kHasHoles] = true;
        kind[kClear] = hole->clear != 0;
        kind[kHoleImage] = is_image(hole->image);
    }
    if (const formats::NormalMapRecord* const map = normal_map_of(asset, primitive)) {
        kind[kNormalMapped] = true;
        kind[kTwoSided] =
            record.shading == formats::Shading::sheet && formats::sheet_shares_of(*map).any();
        kind[kTurned] = kind[kTwoSided] || record.shading == formats::Shading::diffuse;
    }
    return kind;
}

bool has_view(SurfaceKind kind) {
    return kind[kTranslucent] || kind[kGlossy] || kind[kNormalMapped] || kind[kClear];
}

std::string define(const char* name, const std::string& value = {}) {
    return std::string("#define ") + name + " " + value + "\n";
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
        text += define("WRAP_CLAMP", std::to_string(static_cast<int>(formats::Wrap::clamp))) +
                define("WRAP_MIRROR", std::to_string(static_cast<int>(formats::Wrap::mirror))) +
                define("WRAP_NEAREST", std::to_string(formats::kNearestBit)) + image_text;
    }
    text += cube_map_text;
    text += surface_text;
    if (kind[kGlossy]) {
        text += define("LOBE_TAPS", std::to_string(kLobeTaps)) +
                define("ALBEDO_ROWS", std::to_string(formats::kAlbedoRows)) +
                define("ALBEDO_COLUMNS", std::to_string(formats::kAlbedoColumns)) +
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

void set_mirroring(const DrawScene& scene, GLuint program, std::size_t primitive) {
    const SpecularLight& light = scene.specular.light;
    formats::AssetView asset;  // as much of it as a lobe depends on
    asset.roughness = scene.asset.roughness;
    const SpecularLobe lobe = specular_lobe(&light, asset, primitive);
    const bool shows = lobe.radiance != nullptr && has_any(scene.terms, TermSet::specular);
    set_light_from_world(scene.mirror_rotation, program, kLightFromWorld);
    glProgramUniform2f(program, kLobe, lobe.cosine, lobe.sine);
    glProgramUniform1ui(program, kHasSpecular, shows ? 1u : 0u);
    for (std::size_t i = 0; i < light.maps.size(); ++i) {
        if (&light.maps[i].radiance == lobe.radiance) {
            glBindTextureUnit(1, scene.specular.texture[i].name());
        }
    }
}

// Nothing where there is none of that number.
void bind_image(const DrawScene& scene, GLuint unit, GLuint program, GLint location,
                std::uint32_t image, formats::Wrap wrap_u, formats::Wrap wrap_v) {
    if (image >= scene.asset.images.size()) return;
    glBindTextureUnit(unit, scene.asset.images[image].name());
    glProgramUniform2i(program, location, static_cast<GLint>(wrap_u), static_cast<GLint>(wrap_v));
}

void set_gloss(const DrawScene& scene, GLuint program, const formats::GlossRecord& gloss) {
    const GlSpecular& specular = scene.specular;
    set_light_from_world(scene.mirror_rotation, program, kLightFromWorld);
    glProgramUniform1ui(program, kHasSpecular, has_any(scene.terms, TermSet::specular) ? 1u : 0u);
    glProgramUniform4f(program, kF0F90, gloss.f0.r, gloss.f0.g, gloss.f0.b, gloss.f90);
    glProgramUniform2f(program, kMetallicRoughness, gloss.metallic, gloss.roughness);
    glProgramUniform1i(program, kSuns, specular.suns_count);
    glBindTextureUnit(2, specular.light_maps.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, specular.cells.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, specular.suns.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, specular.albedo.name());
    bind_image(scene, 3, program, kGlossWrap, gloss.image, gloss.wrap_u, gloss.wrap_v);
}

void set_own_light(const DrawScene& scene, GLuint program, std::size_t primitive) {
    const bool shows = !scene.own.empty();
    set_vec3(program, kOwnLight,
             shows ? formats::Vec3{scene.own[primitive].r, scene.own[primitive].g,
                                   scene.own[primitive].b}
                   : formats::Vec3{});
    const formats::OwnLight* const own = own_light_of(scene.asset, primitive);
    bind_image(scene, 4, program, kOwnWrap, own->image, own->wrap_u, own->wrap_v);
}

void set_hole(const DrawScene& scene, const TileGrid& grid, GLuint program,
              const formats::HoleRecord& hole) {
    glProgramUniform3f(program, kHole, hole.alpha, hole.cutoff, static_cast<float>(hole.mode));
    glProgramUniform2ui(program, kFirstSample, static_cast<GLuint>(grid.first_column),
                        static_cast<GLuint>(grid.first_row));
    if (hole.clear != 0) {
        const formats::ClearShare clear = formats::clear_share_of(hole);
        glProgramUniform2f(program, kHoleClear, clear.share, clear.eta);
    }
    bind_image(scene, 5, program, kHoleWrap, hole.image, hole.wrap_u, hole.wrap_v);
}

void set_normal_map(const DrawScene& scene, GLuint program, const formats::NormalMapRecord& map) {
    bind_image(scene, 6, program, kNormalWrap, map.image, map.wrap_u, map.wrap_v);
    glProgramUniform1f(program, kNormalScale, map.scale);
}

void set_turned_light(const TurnedLight& light, GLuint program) {
    const auto set = [&](GLint location, formats::Rgb c) {
        set_vec3(program, location, {c.r, c.g, c.b});
    };
    for (std::size_t k = 0; k < light.harmonics.size(); ++k) {
        set(kTurnedLight + static_cast<GLint>(k), light.harmonics[k]);
    }
    set(kTurnedLeast, light.least);
    glProgramUniform1i(program, kTurnedSuns, static_cast<GLint>(light.suns.size()));
    for (std::size_t i = 0; i < light.suns.size(); ++i) {
        const auto at = static_cast<GLint>(i);
        set_vec3(program, kTurnedSunDirection + at, light.suns[i].direction);
        set(kTurnedSunLight + at, light.suns[i].light);
    }
}

// Before the first light there is none to turn.
const TurnedLight& turned_light_of(const DrawScene& scene, std::size_t primitive) {
    static const TurnedLight kNone;
    const TurnedLight* const light =
        scene.turned == nullptr ? nullptr : scene.turned->of(primitive);
    return light == nullptr ? kNone : *light;
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

}  // namespace

formats::Result<SurfacePrograms> make_surface_programs(const GlAsset& asset) {
    SurfacePrograms programs;
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const SurfaceKind kind = surface_kind(asset, p);
        GlProgram& program = programs.program[kind.to_ulong()];
        if (program.name() != 0) continue;
        const std::string fragment = fragment_text(kind);
        const std::string vertex = std::string(openness_text) + surface_vert_text;
        const std::array<StageSource, 2> stages{
            {{GL_VERTEX_SHADER, vertex.c_str()}, {GL_FRAGMENT_SHADER, fragment.c_str()}}};
        auto made =
            make_program("surface", defines_of(kind, asset.vertex_alpha.name() != 0), stages);
        if (!made) return made.error();
        program = std::move(made).value();
    }
    return programs;
}

void draw_surfaces(const DrawScene& scene, const SurfacePrograms& programs, const TileView& view) {
    const GlAsset& asset = scene.asset;
    for (const GlProgram& program : programs.program) {
        if (program.name() != 0) set_view(scene, view, program.name());
    }
    glDepthFunc(GL_GREATER);
    glBindVertexArray(asset.vertex_array.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, asset.srgb_table.name());
    glFrontFace(GL_CW);  // y points down
    glCullFace(GL_BACK);
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const SurfaceKind kind = surface_kind(asset, p);
        (primitive.shows_back() ? glDisable : glEnable)(GL_CULL_FACE);
        const GLuint program = programs.program[kind.to_ulong()].name();
        glUseProgram(program);
        bind_image(scene, 0, program, kWrap, primitive.base_color_image, primitive.wrap_u,
                   primitive.wrap_v);
        if (kind[kTranslucent]) glUniform1f(kEta, primitive.eta);
        if (has_view(kind)) {
            glUniform1ui(kIsDoubleSided, primitive.flags & formats::PrimitiveRecord::kDoubleSided);
        }
        glUniform1f(kShown, is_shown(primitive, scene.terms) ? 1.0f : 0.0f);
        if (kind[kMirroring]) set_mirroring(scene, program, p);
        if (kind[kGlossy]) set_gloss(scene, program, asset.gloss[p]);
        if (kind[kHasHoles]) set_hole(scene, view.grid, program, *hole_of(asset, p));
        if (kind[kNormalMapped]) set_normal_map(scene, program, *normal_map_of(asset, p));
        if (kind[kTurned]) set_turned_light(turned_light_of(scene, p), program);
        if (kind[kGlows]) set_own_light(scene, program, p);
        draw_triangles(primitive);
    }
    glDisable(GL_CULL_FACE);
}

}  // namespace opaline::runtime
