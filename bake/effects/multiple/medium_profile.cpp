#include "bake/effects/multiple/medium_profile.h"

#include <algorithm>
#include <cmath>

#include "bake/plan/plan_input.h"
#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_medium.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

using formats::Medium;

Profile make_profile(Medium::Profile kind, bool paper, double sigma_s_prime, double sigma_a,
                     double eta) {
    if (paper) {
        return make_dipole(DipoleKind::classic_fitted, sigma_s_prime, sigma_a, eta);
    }
    if (kind == Medium::Profile::classic) {
        return make_dipole(DipoleKind::classic, sigma_s_prime, sigma_a, eta);
    }
    if (kind == Medium::Profile::beams) {
        return make_beam_diffusion(sigma_s_prime, sigma_a, eta);
    }
    return make_dipole(DipoleKind::better, sigma_s_prime, sigma_a, eta);
}

}  // namespace

MediumProfile make_medium_profile(const Medium& medium, std::uint64_t seed,
                                  const Context& context) {
    const bool paper = medium.fidelity == Medium::Fidelity::paper;
    const bool unscaled = paper || medium.profile == Medium::Profile::classic;
    const bool normalized = !paper && medium.profile == Medium::Profile::normalized;
    const double g = formats::mean_cosine(medium.phase);
    MediumProfile profile;
    profile.eta = static_cast<double>(medium.eta);
    const double escape = 1 - fresnel_moments(profile.eta).external;
    profile.exit = paper ? 1 : escape;
    double smallest = HUGE_VAL;
    const auto bands = bands_of(medium);
    for (std::size_t b = 0; b < 3; ++b) {
        const auto [sigma_s, sigma_a] = bands[b];
        if (b > 0 && sigma_s == bands[b - 1].sigma_s && sigma_a == bands[b - 1].sigma_a) {
            profile.band[b] = profile.band[b - 1];
            profile.scale[b] = profile.scale[b - 1];
            continue;
        }
        profile.band[b] =
            make_profile(medium.profile, paper, (1 - g) * sigma_s, sigma_a, profile.eta);
        const double total = profile_total(profile.band[b]);
        if (!unscaled && total > 0) {
            const HalfSpaceReflectance walked =
                half_space_reflectance(sigma_s, sigma_a, medium, seed, context);
            if (normalized) {
                profile.band[b] = make_normalized_diffusion(
                    (walked.once + walked.rest) / escape, profile_length(profile.band[b]),
                    DiffusionLength::mean_free_path_diffuse);
            } else {
                profile.scale[b] = walked.rest / (total * escape);
            }
        }
        if (total > 0) {
            smallest = std::min(smallest, profile_length(profile.band[b]));
        }
    }
    profile.smallest = std::isfinite(smallest) ? smallest : 0;
    return profile;
}

std::uint32_t count_samples(double area, const MediumProfile& profile, double per_path,
                            std::uint32_t most) {
    const double least = kLeastSamplesPerPath * per_path;
    const double z = profile.smallest;
    const double wanted = z > 0 ? std::ceil(per_path * area / (z * z)) : 0.0;
    return static_cast<std::uint32_t>(
        std::clamp(wanted, std::min(least, static_cast<double>(most)), static_cast<double>(most)));
}

}  // namespace opaline::bake
