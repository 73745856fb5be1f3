#include "bake/plan/medium_exitance.h"

#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "runtime/view_terms.h"

namespace opaline::bake {

std::vector<float> weigh_rows_of_medium(const RowLayout& layout, float eta, glm::vec3 normal) {
    constexpr std::uint32_t kCosines = 8, kAzimuths = 8;
    const Frame frame = make_frame(normal);
    const formats::Vec3 n{normal.x, normal.y, normal.z};
    std::vector<float> weight(layout.terms()), h(layout.terms(), 1.0f);
    const std::size_t first = layout.first_harmonic();
    for (std::uint32_t i = 0; i < kCosines * kAzimuths; ++i) {
        // Even steps of c^2 are even steps of the cosine-weighted solid angle.
        const float square = (static_cast<float>(i / kAzimuths) + 0.5f) / kCosines;
        const float angle =
            2 * std::numbers::pi_v<float> * (static_cast<float>(i % kAzimuths) + 0.5f) / kAzimuths;
        const float cosine = std::sqrt(square), sine = std::sqrt(1 - square);
        const glm::vec3 w =
            frame.to_world({sine * std::cos(angle), sine * std::sin(angle), cosine});
        if (layout.all_harmonics() > 0) {
            runtime::eval_view_terms(runtime::refract_to_eye(n, {w.x, w.y, w.z}, cosine, eta),
                                     std::span(h).subspan(first));
        }
        const float share = std::numbers::pi_v<float> / (kCosines * kAzimuths) *
                            runtime::fresnel_transmittance(cosine, eta);
        for (std::size_t k = 0; k < weight.size(); ++k) {
            weight[k] += share * h[k];
        }
    }
    return weight;
}

}  // namespace opaline::bake
