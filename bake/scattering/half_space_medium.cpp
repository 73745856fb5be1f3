#include "bake/scattering/half_space_medium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/scattering/fresnel.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kPaths = 65536;  // standard error 0.001
constexpr double kLeastAbsorbed = 1e-3;  // per event, of walks that are really walked

double band_of(const formats::Rgb& c, std::size_t band) {
    return static_cast<double>(band == 0 ? c.r : band == 1 ? c.g : c.b);
}

}  // namespace

HalfSpaceReflectance half_space_reflectance(double sigma_s, double sigma_a,
                                            const formats::Medium& medium, std::uint64_t seed,
                                            const Context& context) {
    const auto eta = static_cast<double>(medium.eta), g = formats::mean_cosine(medium.phase);
    const double absorbed = sigma_a / (sigma_s + sigma_a);
    if (absorbed >= kLeastAbsorbed) {
        return walk_half_space(1 - absorbed, g, eta, kPaths, seed, context);
    }
    // Near albedo 1 the loss grows as the root of what is absorbed per event.
    const HalfSpaceReflectance walked =
        walk_half_space(1 - kLeastAbsorbed, g, eta, kPaths, seed, context);
    const double limit = 1 - fresnel_moments(eta).external - walked.once;
    return {walked.once, limit - (limit - walked.rest) * std::sqrt(absorbed / kLeastAbsorbed)};
}

formats::Rgb half_space_albedo(const formats::Medium& medium, std::uint64_t seed,
                               const Context& context) {
    std::array<float, 3> albedo{};
    for (std::size_t b = 0; b < 3; ++b) {
        const double sigma_s = band_of(medium.sigma_s, b), sigma_a = band_of(medium.sigma_a, b);
        if (sigma_s > 0) {
            const auto walked = half_space_reflectance(sigma_s, sigma_a, medium, seed, context);
            albedo[b] = static_cast<float>(walked.once + walked.rest);
        }
    }
    return {albedo[0], albedo[1], albedo[2]};
}

double count_walk_events(double albedo, double g, double eta) {
    // The number of events grows as the inverse root of the absorption; internal reflection adds
    // more.
    const double s = std::sqrt((1 - albedo) * (1 - albedo * g));
    const double back = std::max(0.0, eta - 1);
    return 1 + (4.9 + 16.6 * back) / (s + (0.4 + 3.8 * back) * s * s);
}

double count_walk_events(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    double events = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        const double sigma_s = band_of(medium.sigma_s, b), sigma_a = band_of(medium.sigma_a, b);
        const bool is_shared = b > 0 && sigma_s == band_of(medium.sigma_s, b - 1) &&
                               sigma_a == band_of(medium.sigma_a, b - 1);
        if (sigma_s > 0 && !is_shared) {
            const double absorbed = sigma_a / (sigma_s + sigma_a);
            events += kPaths * count_walk_events(1 - std::max(absorbed, kLeastAbsorbed), g,
                                                 static_cast<double>(medium.eta));
        }
    }
    return events;
}

}  // namespace opaline::bake
