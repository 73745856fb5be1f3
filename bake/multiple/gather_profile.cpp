#include "bake/multiple/gather_profile.h"

#include <cmath>

namespace opaline::bake {
namespace {

// A profile of this width, in spacings of a blue-noise set, is summed to better than 1 %
// (translucency.md 3.7).
constexpr double kWidthPerSpacing = 1.2;
// Within this radius lie about twenty samples: enough to average, few enough to stay local.
constexpr double kNearSpacings = 2.5;
constexpr double kStepsPerOctave = 64;

}  // namespace

GatherProfile make_gather_profile(const MediumProfile& medium, double spacing,
                                  double largest_distance) {
    GatherProfile profile;
    if (!(medium.smallest > 0)) {
        return profile;  // nothing scatters: an empty table, 0 everywhere
    }
    const double wanted = kWidthPerSpacing * spacing;
    std::array<double, 3> b_squared{};
    for (std::size_t b = 0; b < 3; ++b) {
        const double width = profile_width(medium.band[b]);
        profile.total[b] = medium.total(b);
        if (profile.total[b] > 0 && width < wanted) {
            b_squared[b] = wanted * wanted - width * width;
            profile.near_mass[b] =
                static_cast<float>(profile.total[b] - medium.tail(b, std::sqrt(b_squared[b])));
            profile.near_radius = static_cast<float>(kNearSpacings * spacing);
        }
    }
    const double z = std::max(medium.smallest, wanted);
    profile.steps_per_octave = kStepsPerOctave;
    profile.inverse_z_squared = 1 / (z * z);
    const double octaves =
        std::log2(1 + largest_distance * largest_distance * profile.inverse_z_squared);
    const auto entries = static_cast<std::size_t>(std::ceil(octaves * kStepsPerOctave)) + 2;
    for (std::size_t i = 0; i < entries; ++i) {
        const double r2 = z * z * (std::exp2(static_cast<double>(i) / kStepsPerOctave) - 1);
        std::array<float, 3> value{};
        for (std::size_t b = 0; b < 3; ++b) {
            value[b] = static_cast<float>(medium.eval(b, std::sqrt(r2 + b_squared[b])));
        }
        profile.table.push_back(value);
    }
    return profile;
}

std::array<float, 3> eval_far(const GatherProfile& profile, float r2) {
    const double at = std::log2(1 + static_cast<double>(r2) * profile.inverse_z_squared) *
                      profile.steps_per_octave;
    if (!(at < static_cast<double>(profile.table.size()) - 1)) {
        return {};
    }
    const auto i = static_cast<std::size_t>(at);
    const auto f = static_cast<float>(at - static_cast<double>(i));
    std::array<float, 3> value{};
    for (std::size_t b = 0; b < 3; ++b) {
        value[b] = profile.table[i][b] + f * (profile.table[i + 1][b] - profile.table[i][b]);
    }
    return value;
}

}  // namespace opaline::bake
