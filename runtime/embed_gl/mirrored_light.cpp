#include "runtime/embed_gl/mirrored_light.h"

#include <algorithm>
#include <array>

namespace opaline::runtime {

void MirroredLight::make(const formats::AssetView& asset, GlNames& names) {
    roughness_.assign(asset.roughness.begin(), asset.roughness.end());
    levels_ = roughness_levels(asset);
    constexpr std::array<float, 3 * 6> kBlack{};
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        textures_.push_back(names.make_array_texture());
        fill_faces(gl_, textures_.back(), 0, 1, kBlack.data());
    }
}

void MirroredLight::upload(const SpecularLight& light) {
    for (const SpecularLight::Map& map : light.maps) {
        const auto level = std::ranges::lower_bound(levels_, map.level);
        if (level == levels_.end() || *level != map.level) continue;
        fill_faces(gl_, textures_[static_cast<std::size_t>(level - levels_.begin())], 0,
                   map.radiance.width, &map.radiance.pixel.front().r);
    }
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
