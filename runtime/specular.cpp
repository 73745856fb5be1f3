#include "runtime/specular.h"

#include <algorithm>
#include <cmath>

namespace opaline::runtime {

using formats::Rgb;
using formats::Vec3;

std::uint32_t roughness_level(float roughness) {
    return static_cast<std::uint32_t>(std::lround(roughness * kRoughnessSteps));
}

std::vector<std::uint32_t> roughness_levels(const formats::AssetView& asset) {
    std::vector<std::uint32_t> levels;
    for (std::uint32_t level = 0; level <= kRoughnessSteps; ++level) {
        const bool is_used =
            std::any_of(asset.roughness.begin(), asset.roughness.end(),
                        [&](float r) { return r >= 0 && roughness_level(r) == level; });
        if (is_used) levels.push_back(level);
    }
    return levels;
}

SpecularNeeds specular_needs(const formats::AssetView& asset) {
    return {roughness_levels(asset),
            std::any_of(asset.gloss.begin(), asset.gloss.end(),
                        [](const formats::GlossRecord& gloss) { return gloss.is_glossy(); })};
}

SpecularLobe lobe_of_alpha(float alpha) {
    alpha = std::max(alpha, 0.05f);
    SpecularLobe lobe;
    lobe.cosine = (1 - alpha * alpha) / (1 + alpha * alpha);
    lobe.sine = 2 * alpha / (1 + alpha * alpha);
    return lobe;
}

SpecularLobe specular_lobe(const SpecularLight* light, const formats::AssetView& asset,
                           std::size_t primitive) {
    if (asset.roughness.empty() || !(asset.roughness[primitive] >= 0)) return {};
    const std::uint32_t level = roughness_level(asset.roughness[primitive]);
    const float roughness = static_cast<float>(level) / kRoughnessSteps;
    SpecularLobe lobe = lobe_of_alpha(roughness * roughness);
    lobe.is_glossy = true;
    if (light == nullptr) return lobe;
    for (const SpecularLight::Map& map : light->maps) {
        if (map.level == level) lobe.radiance = &map.radiance;
    }
    return lobe;
}

float specular_visibility(Vec3 axis, float open, Vec3 mirrored, const SpecularLobe& lobe) {
    open = open > 0 ? std::min(open, 1.0f) : 0.0f;
    const float cosine = std::sqrt(1 - open), sine = std::sqrt(open);
    const float low = cosine * lobe.cosine - sine * lobe.sine;
    const float high = cosine * lobe.cosine + sine * lobe.sine;
    const float at =
        high > low ? std::clamp((dot(axis, mirrored) - low) / (high - low), 0.0f, 1.0f) : 0.0f;
    const float fits = std::min(1.0f, (1 - cosine) / (1 - lobe.cosine));
    const float inside = fits * at * at * (3 - 2 * at);
    const float squared = open * open, fourth = squared * squared;
    return 1 - (1 - inside) * (1 - fourth * fourth);
}

MirroredShares mirrored_shares(const SpecularLobe& lobe, const ViewOfReceiver& view, float eta,
                               Vec3 axis, float open) {
    constexpr float kFade = 0.2f;
    const Vec3 n = view.normal;
    if (!lobe.is_glossy || !(dot(n, n) > 0) || !(view.cosine > -2 * kFade)) return {};
    // Not 0, where everything is reflected even of a boundary of index 1, which reflects nothing.
    constexpr float kLeastCosine = 1e-6f;
    const float c = std::clamp(view.cosine, kLeastCosine, 1.0f);
    const float behind = std::max(-view.cosine, 0.0f) / kFade;
    Vec3 mirrored = 2 * c * n - view.to_eye;
    const float norm = length(mirrored);
    if (!(norm > 0) || !std::isfinite(norm)) return {};
    mirrored = (1 / norm) * mirrored;
    if (view.is_turned) {
        axis = axis - 2 * dot(axis, n) * n;
    }
    const float sky = std::max(1 - behind, 0.0f) * specular_visibility(axis, open, mirrored, lobe);
    const float mirrors = 1 - fresnel_transmittance(c, eta);
    return {mirrored, mirrors * sky, mirrors * std::min(2 - behind, 1.0f) * (1 - sky)};
}

Rgb eval_specular(const SpecularLight& light, const SpecularLobe& lobe, const ViewOfReceiver& view,
                  float eta, Vec3 axis, float open) {
    const MirroredShares shares = mirrored_shares(lobe, view, eta, axis, open);
    if (lobe.radiance == nullptr || !(shares.sky > 0)) return {};
    return shares.sky *
           formats::sample_map(*lobe.radiance, light.rotation.light_from_world(shares.direction));
}

}  // namespace opaline::runtime
