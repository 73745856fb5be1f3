#include "bake/plan/scattered_once.h"

#include <algorithm>

#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/half_space_once.h"
#include "bake/physics/phase_series.h"
#include "bake/plan/plan_input.h"
#include "formats/media/mean_cosine.h"

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

}  // namespace opaline::bake
