#include "runtime/volumes/volume_source.h"

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
