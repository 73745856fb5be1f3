#include "runtime/volumes/volume_source.h"

#include <algorithm>

#include "formats/opal/phase_table.h"

namespace opaline::runtime {

SourceWeights source_weights(const VolumeLight& light, std::size_t volume, formats::Vec3 to_eye) {
    const VolumeLight::Part& part = light.part[volume];
    SourceWeights weight{};
    if (part.terms > 0) {
        formats::eval_spherical_harmonics(to_eye, std::span<float>(weight).first(part.terms));
    }
    if (part.suns == 0) return weight;
    const std::span<const float> table = light.sun_phase[volume].table;
    std::size_t k = part.terms;
    for (std::size_t j = 0; j < part.sun_terms; ++j) {
        for (std::size_t s = 0; s < part.suns; ++s) {
            // Light from a sun travels along -l.
            weight[k++] = formats::eval_phase_table(
                table.subspan(j * formats::kPhaseEntries, formats::kPhaseEntries),
                -dot(light.sun[s], to_eye));
        }
    }
    return weight;
}

float ahead_share(formats::Vec3 sun, formats::Vec3 to_eye) {
    constexpr float kWidth = 0.0437048f;  // 2 - 2 cos(12 degrees)
    // Not by a cosine, which is 1 for all small angles.
    const formats::Vec3 off = sun + to_eye;
    const float u = std::min(dot(off, off) / kWidth, 1.0f);
    return (1 - u * u) * (1 - u * u);
}

SourceWeights ahead_weights(const VolumeLight& light, std::size_t volume, formats::Vec3 to_eye) {
    const VolumeLight::Part& part = light.part[volume];
    SourceWeights weight = source_weights(light, volume, to_eye);
    std::fill_n(weight.begin(), part.terms, 0.0f);
    for (std::size_t k = 0; k < part.suns * part.sun_terms; ++k) {
        weight[part.terms + k] *= ahead_share(light.sun[k % part.suns], to_eye);
    }
    return weight;
}

SourceWeights mean_weights(const VolumeLight& light, std::size_t volume) {
    const VolumeLight::Part& part = light.part[volume];
    SourceWeights weight{};
    weight[0] = 0.2820947918f;  // Y_0 = 1 / sqrt(4 pi)
    std::size_t k = part.terms;
    for (std::size_t j = 0; j < part.sun_terms; ++j) {
        for (std::size_t s = 0; s < part.suns; ++s) {
            weight[k++] = light.sun_phase[volume].mean[j];
        }
    }
    return weight;
}

}  // namespace opaline::runtime
