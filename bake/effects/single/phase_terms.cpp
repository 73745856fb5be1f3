#include "bake/effects/single/phase_terms.h"

#include <cmath>
#include <numbers>

#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr float kIsotropic = 0.25f * std::numbers::inv_pi_v<float>;

}  // namespace

std::vector<float> largest_phase_terms(const PhaseTerms& phase) {
    if (phase.lambda.size() == 1) {
        return {kIsotropic};
    }
    constexpr float kRounding = 1.000001f;
    std::vector<float> largest;
    for (std::size_t l = 0; l < phase.lambda.size(); ++l) {
        // The squares of a degree's harmonics sum to (2 l + 1) / (4 pi) in every direction.
        const float orders = static_cast<float>(2 * l + 1);
        largest.insert(largest.end(), 2 * l + 1,
                       kRounding * std::abs(phase.lambda[l]) * std::sqrt(kIsotropic * orders));
    }
    return largest;
}

void eval_phase_terms(const PhaseTerms& phase, float eta, glm::vec3 w, glm::vec3 normal,
                      const Entry<float>& entry, float cosine, std::span<float> value) {
    if (value.size() == 1) {
        value[0] = kIsotropic;
        return;
    }
    const glm::vec3 inside = (w - cosine * normal) / eta + entry.refracted_cosine * normal;
    formats::eval_spherical_harmonics({-inside.x, -inside.y, -inside.z}, value);
    std::size_t k = 0;
    for (std::size_t l = 0; l < phase.lambda.size(); ++l) {
        for (std::size_t m = 0; m < 2 * l + 1; ++m) {
            value[k++] *= phase.lambda[l];
        }
    }
}

}  // namespace opaline::bake
