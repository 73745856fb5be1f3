#include "runtime/embed_gl/layer_textures.h"

#include <algorithm>
#include <span>
#include <vector>

#include "runtime/api_support.h"

namespace opaline::runtime {
namespace {

// The end of the block in layer_tables.glsl, in std140.
struct EyeInLayer {
    std::array<std::int32_t, 4> value_first{};
    std::array<float, 2> field_origin{}, albedo_origin{}, light_origin{};
    float above_base = 0, above_ground = 0;
};
static_assert(sizeof(EyeInLayer) == 48);

}  // namespace

opaline_status LayerTextures::check_sizes(const LayerLight& light) const {
    std::size_t texels = 0;
    for (const MipLevel<float>& level : light.field.thickness.level)
        texels += level.value.size();
    if (light.field.thickness.level.size() > kMaxLayerLevels) {
        return api::fail(OPALINE_GL_REFUSED,
                         "the layer's thickness has more than 65535 texels along a side");
    }
    GLint side = 0;
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    if (std::max(light.record.ground_columns, light.record.ground_rows) >
        static_cast<std::uint32_t>(std::max(side, 0))) {
        return api::fail(OPALINE_GL_REFUSED,
                         "the layer's ground has more pixels a side than a texture of the driver");
    }
    return check_lines(gl_, "thickness of the layer", texels);
}

void LayerTextures::fill_picture(GLuint texture, std::size_t level,
                                 const MipLevel<formats::Rgb>& picture) {
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    gl_.TexImage2D(GL_TEXTURE_2D, static_cast<GLint>(level), GL_RGB32F,
                   static_cast<GLsizei>(picture.columns), static_cast<GLsizei>(picture.rows), 0,
                   GL_RGB, GL_FLOAT, picture.value.data());
}

// What no light changes.
void LayerTextures::make(const LayerLight& light, GlNames& names) {
    for (TexelLines* lines : {&table_values_, &sun_values_, &thickness_values_}) {
        lines->make(names);
    }
    std::vector<float> tables = pack_layer_phase(light);
    const std::vector<float> flux = pack_layer_flux(light), glow = pack_layer_glow(light);
    value_first_[0] = static_cast<std::int32_t>(tables.size());
    tables.insert(tables.end(), flux.begin(), flux.end());
    value_first_[1] = static_cast<std::int32_t>(tables.size());
    tables.insert(tables.end(), glow.begin(), glow.end());
    table_values_.fill_of(std::span<const float>(tables));
    const GLuint albedo_map = names.make_table_texture();
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    for (std::size_t i = 0; i < light.albedo.level.size(); ++i) {
        fill_picture(albedo_map, i, light.albedo.level[i]);
    }
    const LayerKind kind = layer_kind(light);
    objects_ = {sizeof objects_,
                kind.repeats ? 1u : 0u,
                kind.modes,
                kind.glows ? 1u : 0u,
                names.make_buffer(sizeof(ShaderLayer) + sizeof(EyeInLayer), GL_DYNAMIC_DRAW),
                table_values_.name(),
                sun_values_.name(),
                thickness_values_.name(),
                albedo_map,
                names.make_table_texture(),
                names.make_table_texture()};
}

opaline_status LayerTextures::show(const LayerLight& light, formats::Vec3 eye, GlNames& names) {
    const bool is_first = !is_shown();
    if (is_first) {
        if (const opaline_status status = check_sizes(light); status != OPALINE_OK) return status;
        make(light, names);
    }
    if (is_first || frames_ != light.field.frames) {
        thickness_values_.fill_of(std::span<const float>(pack_thickness(light)));
        frames_ = light.field.frames;
    }
    std::vector<float> suns = pack_sun_tables(light);
    const std::vector<float> flux = pack_sun_flux(light);
    value_first_[2] = static_cast<std::int32_t>(suns.size());
    suns.insert(suns.end(), flux.begin(), flux.end());
    sun_values_.fill_of(std::span<const float>(suns));
    fill_picture(objects_.ground_light, 0, light.ground_light.cell);
    fill_picture(objects_.base_light, 0, light.base_light.cell);
    const ShaderLayer record = make_shader_layer(light);
    places_ = layer_places(light);
    fill_buffer(gl_, objects_.block, 0, std::as_bytes(std::span(&record, 1)));
    look_from(eye);
    return OPALINE_OK;
}

void LayerTextures::look_from(formats::Vec3 eye) {
    if (!is_shown()) return;
    const double height = static_cast<double>(eye.y);
    const EyeInLayer seen{value_first_,
                          places_.field.place_of(eye),
                          places_.ground.place_of(eye),
                          places_.light.place_of(eye),
                          static_cast<float>(height - places_.base),
                          static_cast<float>(height - places_.ground_height)};
    fill_buffer(gl_, objects_.block, sizeof(ShaderLayer), std::as_bytes(std::span(&seen, 1)));
}

}  // namespace opaline::runtime
