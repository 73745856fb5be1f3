#include "runtime/embed_gl/mirrored_light.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "formats/opal/ggx_albedo.h"
#include "runtime/gloss.h"

namespace opaline::runtime {

void GlossyLight::make(GlNames& names, opaline_gl_objects& objects) {
    maps_ = objects.light_maps = names.make_array_texture();
    gl_.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    constexpr std::array<float, 3 * 6> kBlack{};
    fill_faces(gl_, maps_, 0, 1, kBlack.data());
    cells_ = objects.cells = names.make_table_texture();
    suns_ = objects.sun_table = names.make_table_texture();
    objects.albedo = names.make_table_texture();
    fill_table(gl_, cells_, 2, std::span(kBlack).first(8));
    fill_table(gl_, suns_, 2, std::span(kBlack).first(8));
    std::vector<float> albedo;
    albedo.reserve(4 * formats::ggx_albedo_table().size());
    for (const formats::GgxAlbedo& entry : formats::ggx_albedo_table()) {
        albedo.insert(albedo.end(), {entry.of_f0, entry.of_f90, 0, 0});
    }
    fill_table(gl_, objects.albedo, formats::kAlbedoColumns, albedo);
}

void GlossyLight::upload(const GlossLight& light) {
    if (light.map.empty()) return;
    for (std::size_t level = 0; level < light.map.size(); ++level) {
        const formats::Environment& map = light.map[level];
        fill_faces(gl_, maps_, level, map.width, &map.pixel.front().r);
    }
    std::vector<float> suns = make_sun_table(light);
    if (suns.empty()) suns.resize(8);  // one that lights nothing
    fill_table(gl_, cells_, 2, make_cell_table(light));
    fill_table(gl_, suns_, 2, suns);
}

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
