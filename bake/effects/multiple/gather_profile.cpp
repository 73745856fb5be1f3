#include "bake/effects/multiple/gather_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace opaline::bake {
namespace {

// About twenty samples lie within this radius: enough for a mean, and still local.
constexpr double kNearSpacings = 2.5;

// The table has 64 evenly spaced steps per octave, so a step is the leading bits of a float.
constexpr std::uint32_t kFractionBits = 23 - 6;
constexpr auto kOne = std::bit_cast<std::uint32_t>(1.0f);

struct Place {
    std::uint32_t step;
    float fraction;  // of the way to the next step
};

// `x` >= 1.
Place place_of(float x) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - kOne;
    const std::uint32_t fraction = bits & ((1u << kFractionBits) - 1);
    return {bits >> kFractionBits,
            static_cast<float>(fraction) / static_cast<float>(1u << kFractionBits)};
}

float start_of(std::uint32_t step) {
    return std::bit_cast<float>(kOne + (step << kFractionBits));
}

}  // namespace

GatherProfile make_gather_profile(const MediumProfile& medium, double spacing,
                                  double largest_distance, std::uint32_t bands) {
    GatherProfile profile;
    profile.bands = bands;
    if (!(medium.smallest > 0)) {
        return profile;  // nothing scatters: an empty table, 0 everywhere
    }
    const double wanted = kWidthPerSpacing * spacing;
    std::array<double, 3> b_squared{};
    for (std::size_t b = 0; b < bands; ++b) {
        const double width = profile_width(medium.band[b]);
        profile.total[b] = medium.total(b);
        if (profile.total[b] > 0 && width < wanted) {
            b_squared[b] = wanted * wanted - width * width;
            profile.near_mass[b] =
                static_cast<float>(profile.total[b] - medium.tail(b, std::sqrt(b_squared[b])));
            profile.near_radius = static_cast<float>(kNearSpacings * spacing);
        }
    }
    constexpr double kLeast = 1e-37;  // [m^2] keeps the inverse in the range of a float
    const double z_squared = std::max(kLeast, std::pow(std::max(medium.smallest, wanted), 2));
    profile.inverse_z_squared = static_cast<float>(1 / z_squared);
    constexpr float kMost =
        1e30f;  // keeps the distance in the range of a float; nothing arrives from there
    const auto farthest = static_cast<float>(largest_distance * largest_distance);
    const std::uint32_t entries =
        place_of(std::min(kMost, 1 + farthest * profile.inverse_z_squared)).step + 2;
    for (std::uint32_t i = 0; i < entries; ++i) {
        const double r2 = z_squared * (static_cast<double>(start_of(i)) - 1);
        for (std::size_t b = 0; b < bands; ++b) {
            profile.table.push_back(
                static_cast<float>(medium.eval(b, std::sqrt(r2 + b_squared[b]))));
        }
    }
    return profile;
}

std::array<float, 3> eval_far(const GatherProfile& profile, float r2) {
    const auto [step, f] = place_of(1 + r2 * profile.inverse_z_squared);
    const std::size_t bands = profile.bands, at = bands * step;
    if (at + bands >= profile.table.size()) {
        return {};
    }
    const float* const here = &profile.table[at];
    // C++20 allows it, but clang 14 does not capture f itself.
    const auto between = [&, share = f](std::size_t b) {
        return here[b] + share * (here[bands + b] - here[b]);
    };
    return bands == 1 ? std::array{between(0), 0.0f, 0.0f}
                      : std::array{between(0), between(1), between(2)};
}

}  // namespace opaline::bake
