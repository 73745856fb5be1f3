#include "bake/multiple/medium_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_walk.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

using formats::Medium;

double band_of(const formats::Rgb& c, std::size_t band) {
    return static_cast<double>(band == 0 ? c.r : band == 1 ? c.g : c.b);
}

// What a half space returns of uniform light beyond single scattering, per incident flux.
double multiple_reflectance(double sigma_s, double sigma_a, double g, double eta, double escape,
                            std::uint64_t seed, const Context& context) {
    constexpr std::uint32_t kPaths = 65536;  // standard error 0.001
    constexpr double kLeastAbsorbed = 1e-3;
    const double absorbed = sigma_a / (sigma_s + sigma_a);
    if (absorbed >= kLeastAbsorbed) {
        return walk_half_space(1 - absorbed, g, eta, kPaths, seed, context).multiple;
    }
    // Walks without end: near albedo 1 the loss grows as the root of what is absorbed per event.
    const HalfSpaceReflectance walked =
        walk_half_space(1 - kLeastAbsorbed, g, eta, kPaths, seed, context);
    const double limit = escape - walked.single;
    return limit - (limit - walked.multiple) * std::sqrt(absorbed / kLeastAbsorbed);
}

}  // namespace

MediumProfile make_medium_profile(const Medium& medium, double largest_distance, std::uint64_t seed,
                                  const Context& context) {
    const bool paper = medium.fidelity == Medium::Fidelity::paper;
    const bool classic = paper || medium.profile == Medium::Profile::classic;
    const double g = formats::mean_cosine(medium.phase);
    MediumProfile profile;
    profile.eta = static_cast<double>(medium.eta);
    const double escape = 1 - fresnel_moments(profile.eta).external;
    profile.exit = paper ? 1 : escape;
    profile.smallest_z = HUGE_VAL;
    for (std::size_t band = 0; band < 3; ++band) {
        const double sigma_s = band_of(medium.sigma_s, band),
                     sigma_a = band_of(medium.sigma_a, band);
        profile.dipole[band] = make_dipole(paper     ? DipoleKind::classic_fitted
                                           : classic ? DipoleKind::classic
                                                     : DipoleKind::better,
                                           (1 - g) * sigma_s, sigma_a, profile.eta);
        if (profile.dipole[band].z_real > 0) {
            profile.smallest_z = std::min(profile.smallest_z, profile.dipole[band].z_real);
        }
        if (!classic) {
            const bool repeated = band > 0 && sigma_s == band_of(medium.sigma_s, band - 1) &&
                                  sigma_a == band_of(medium.sigma_a, band - 1);
            const double total = dipole_total(profile.dipole[band]);
            profile.scale[band] = total == 0 ? 1
                                  : repeated
                                      ? profile.scale[band - 1]
                                      : multiple_reflectance(sigma_s, sigma_a, g, profile.eta,
                                                             escape, seed, context) /
                                            (total * escape);
        }
    }
    if (!std::isfinite(profile.smallest_z)) {
        return profile;  // nothing scatters: an empty table, 0 everywhere
    }
    constexpr double kStepsPerOctave = 64;
    profile.steps_per_octave = kStepsPerOctave;
    profile.inverse_z_squared = 1 / (profile.smallest_z * profile.smallest_z);
    const double octaves =
        std::log2(1 + largest_distance * largest_distance * profile.inverse_z_squared);
    const auto entries = static_cast<std::size_t>(std::ceil(octaves * kStepsPerOctave)) + 2;
    for (std::size_t i = 0; i < entries; ++i) {
        const double r =
            profile.smallest_z * std::sqrt(std::exp2(static_cast<double>(i) / kStepsPerOctave) - 1);
        std::array<float, 3> value{};
        for (std::size_t band = 0; band < 3; ++band) {
            value[band] =
                static_cast<float>(profile.scale[band] * eval_dipole(profile.dipole[band], r));
        }
        profile.table.push_back(value);
    }
    return profile;
}

std::array<float, 3> eval_profile(const MediumProfile& profile, float r2) {
    const double at = std::log2(1 + static_cast<double>(r2) * profile.inverse_z_squared) *
                      profile.steps_per_octave;
    if (!(at < static_cast<double>(profile.table.size()) - 1)) {
        return {};
    }
    const auto i = static_cast<std::size_t>(at);
    const auto f = static_cast<float>(at - static_cast<double>(i));
    std::array<float, 3> value{};
    for (std::size_t band = 0; band < 3; ++band) {
        value[band] =
            profile.table[i][band] + f * (profile.table[i + 1][band] - profile.table[i][band]);
    }
    return value;
}

}  // namespace opaline::bake
