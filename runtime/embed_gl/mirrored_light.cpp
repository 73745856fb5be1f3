#include "runtime/embed_gl/mirrored_light.h"

#include <algorithm>

namespace opaline::runtime {

void MirroredLight::make(const formats::AssetView& asset, GlNames& names) {
    roughness_.assign(asset.roughness.begin(), asset.roughness.end());
    levels_ = roughness_levels(asset);
    const std::vector<float> black(std::size_t{4} * 6);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        textures_.push_back(names.make_array_texture());
        upload_map(textures_.back(), 1, black.data());
    }
}

void MirroredLight::upload(const SpecularLight& light) {
    for (const SpecularLight::Map& map : light.maps) {
        const auto level = std::ranges::lower_bound(levels_, map.level);
        if (level == levels_.end() || *level != map.level) continue;
        // OpenGL ES takes four floats a texel.
        std::vector<float> rgba;
        rgba.reserve(4 * map.radiance.pixel.size());
        for (const formats::Rgb pixel : map.radiance.pixel) {
            rgba.insert(rgba.end(), {pixel.r, pixel.g, pixel.b, 0});
        }
        upload_map(textures_[static_cast<std::size_t>(level - levels_.begin())], map.radiance.width,
                   rgba.data());
    }
}

void MirroredLight::upload_map(GLuint texture, std::uint32_t size, const float* rgba) const {
    const auto n = static_cast<GLsizei>(size);
    gl_.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
    gl_.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, n, n, 6, 0, GL_RGBA, GL_FLOAT, rgba);
}

MirroredLight::Lobe MirroredLight::lobe_of(std::size_t primitive) const {
    if (primitive >= roughness_.size() || !(roughness_[primitive] >= 0)) return {};
    const std::uint32_t level = roughness_level(roughness_[primitive]);
    const auto at = std::ranges::lower_bound(levels_, level) - levels_.begin();
    const float roughness = static_cast<float>(level) / kRoughnessSteps;
    const SpecularLobe cone = lobe_of_alpha(roughness * roughness);
    return {textures_[static_cast<std::size_t>(at)], cone.cosine, cone.sine};
}

}  // namespace opaline::runtime
