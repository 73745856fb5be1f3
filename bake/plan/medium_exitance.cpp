#include "bake/plan/medium_exitance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/half_space_once.h"
#include "bake/physics/phase_series.h"
#include "bake/plan/plan_input.h"
#include "formats/media/mean_cosine.h"
#include "runtime/view_terms.h"

namespace opaline::bake {

double share_scattered_once(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    const auto eta = static_cast<double>(medium.eta);
    const double reflected = half_space_once(eta), escape = 1 - fresnel_moments(eta).external;
    double share = 0;
    for (const auto& [sigma_s, sigma_a] : bands_of(medium)) {
        if (sigma_s > 0) {
            const double once = reflected * sigma_s / (sigma_s + sigma_a);
            const double rest = escape * dipole_total(make_dipole(DipoleKind::better,
                                                                  (1 - g) * sigma_s, sigma_a, eta));
            share = std::max(share, once / (once + rest));
        }
    }
    return share;
}

double once_error(const formats::Medium& medium, unsigned terms) {
    constexpr unsigned kDegrees = 5;
    return share_scattered_once(medium) *
           phase_rms_relative(expand_phase(medium.phase, kDegrees), terms);
}

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
