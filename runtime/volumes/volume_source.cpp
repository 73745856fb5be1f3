#include "runtime/volumes/volume_source.h"

#include <numbers>

#include "formats/opal/phase_table.h"

namespace opaline::runtime {

SourceWeights source_weights(const VolumeLight& light, std::size_t volume,
                             std::span<const float> phase, formats::Vec3 to_eye) {
    const VolumeLight::Part& part = light.part[volume];
    SourceWeights weight{};
    if (part.terms > 0) {
        formats::eval_spherical_harmonics(to_eye, std::span<float>(weight).first(part.terms));
    }
    for (std::size_t s = 0; s < part.suns; ++s) {
        // Light from a sun travels along -l.
        weight[part.terms + s] = formats::eval_phase_table(phase, -dot(light.sun[s], to_eye));
    }
    return weight;
}

SourceWeights mean_weights(const VolumeLight& light, std::size_t volume) {
    const VolumeLight::Part& part = light.part[volume];
    SourceWeights weight{};
    weight[0] = 0.2820947918f;  // Y_0 = 1 / sqrt(4 pi)
    for (std::size_t s = 0; s < part.suns; ++s) {
        weight[part.terms + s] = 1 / (4 * std::numbers::pi_v<float>);
    }
    return weight;
}

}  // namespace opaline::runtime
