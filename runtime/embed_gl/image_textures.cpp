#include "runtime/embed_gl/image_textures.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <type_traits>

#include "formats/opal/thin_glass.h"
#include "runtime/api_support.h"
#include "runtime/texture.h"
#include "runtime/volumes/suns.h"

namespace opaline::runtime {
namespace {

static_assert(kMaxSuns == std::extent_v<decltype(opaline_gl_normal_map::sun_light)>);

void put(formats::Rgb c, float (&to)[3]) {
    to[0] = c.r;
    to[1] = c.g;
    to[2] = c.b;
}

}  // namespace

GLuint ImageTextures::upload(const formats::PreviewImage& image, GlNames& names) const {
    const GLuint name = names.make_table_texture();
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8UI, static_cast<GLsizei>(image.width),
                   static_cast<GLsizei>(image.height), 0, GL_RGB_INTEGER, GL_UNSIGNED_BYTE,
                   image.rgb.data());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    return name;
}

opaline_gl_image ImageTextures::find(std::uint32_t image, formats::Wrap u, formats::Wrap v) const {
    if (image >= texture_.size()) return {};
    return {texture_[image], {static_cast<std::int32_t>(u), static_cast<std::int32_t>(v)}};
}

opaline_status ImageTextures::make(const formats::AssetView& asset, GlNames& names) {
    GLint limit = 0;
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (!asset.texcoord.empty()) {  // else there is nowhere to look them up
        for (const formats::PreviewImage& image : asset.images) {
            if (std::max(image.width, image.height) >
                static_cast<std::uint32_t>(std::max(limit, 0))) {
                char text[120];
                std::snprintf(text, sizeof text,
                              "an image of %ux%u pixels: the driver takes at most %d a side",
                              image.width, image.height, limit);
                return api::fail(OPALINE_GL_REFUSED, text);
            }
            texture_.push_back(upload(image, names));
        }
    }
    std::array<float, 256> linear{};
    for (std::size_t code = 0; code < linear.size(); ++code) {
        linear[code] = linear_from_srgb(static_cast<std::uint8_t>(code));
    }
    srgb_table_ = names.make_table_texture();
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, static_cast<GLsizei>(linear.size()), 1, 0, GL_RED,
                   GL_FLOAT, linear.data());
    if (!asset.holes.vertex_alpha.empty()) {
        vertex_alpha_ = names.make_buffer_of(asset.holes.vertex_alpha);
    }
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& record = asset.primitives[p];
        opaline_gl_images images{};
        images.base_color = find(record.base_color_image, record.wrap_u, record.wrap_v);
        if (!asset.gloss.empty() && asset.gloss[p].is_glossy()) {
            const formats::GlossRecord& gloss = asset.gloss[p];
            images.gloss = find(gloss.image, gloss.wrap_u, gloss.wrap_v);
        }
        if (const formats::OwnLight* const own = asset.emitters.own_of(p)) {
            images.emission = find(own->image, own->wrap_u, own->wrap_v);
        }
        images.alpha_factor = 1;
        if (const formats::HoleRecord* const hole = asset.holes.of(p)) {
            images.alpha = find(hole->image, hole->wrap_u, hole->wrap_v);
            images.alpha_factor = hole->alpha;
            images.cutoff_mode[0] = hole->cutoff;
            images.cutoff_mode[1] = static_cast<float>(hole->mode);
            images.vertex_alpha = vertex_alpha_;
            if (hole->clear != 0) {  // hosts know no angle: as seen along the normal
                const formats::ClearShare clear = formats::clear_share_of(*hole);
                images.alpha_factor *=
                    1 - clear.share * formats::thin_glass_transmittance(1, clear.eta);
            }
        }
        images.srgb_table = srgb_table_;
        primitive_.push_back(images);
    }
    make_normal_maps(asset, names);
    return OPALINE_OK;
}

void ImageTextures::make_normal_maps(const formats::AssetView& asset, GlNames& names) {
    if (asset.normal_maps.empty()) return;
    record_.assign(asset.normal_maps.record.begin(), asset.normal_maps.record.end());
    tangent_ = names.make_buffer_of(asset.normal_maps.tangent);
    for (const formats::NormalMapRecord& record : record_) {
        opaline_gl_normal_map& map = normal_map_[record.primitive];
        map.image = find(record.image, record.wrap_u, record.wrap_v);
        map.scale = record.scale;
        map.tangent = tangent_;
        const formats::Shading shading = asset.primitives[record.primitive].shading;
        const bool two_sided =
            shading == formats::Shading::sheet && formats::sheet_shares_of(record).any();
        map.is_turned = two_sided ? 2 : shading == formats::Shading::diffuse ? 1 : 0;
    }
}

void ImageTextures::relight(const PartLights& lights,
                            std::span<const formats::PrimitiveRecord> primitives) {
    turned_ = make_turned_lights(lights, primitives, record_);
}

opaline_gl_normal_map ImageTextures::normal_map_of(std::uint32_t primitive) const {
    const auto found = normal_map_.find(primitive);
    if (found == normal_map_.end()) return {};
    opaline_gl_normal_map map = found->second;
    const TurnedLight* const turned = turned_.of(primitive);
    if (turned == nullptr) return map;
    for (std::size_t k = 0; k < turned->harmonics.size(); ++k) {
        put(turned->harmonics[k], map.harmonics[k]);
    }
    put(turned->least, map.least);
    map.suns = static_cast<std::int32_t>(turned->suns.size());
    for (std::size_t i = 0; i < turned->suns.size(); ++i) {
        const TurnedLight::Sun& sun = turned->suns[i];
        put({sun.direction.x, sun.direction.y, sun.direction.z}, map.sun_direction[i]);
        put(sun.light, map.sun_light[i]);
    }
    return map;
}

opaline_gl_images ImageTextures::of(std::uint32_t primitive) const {
    return primitive < primitive_.size() ? primitive_[primitive] : opaline_gl_images{};
}

}  // namespace opaline::runtime
