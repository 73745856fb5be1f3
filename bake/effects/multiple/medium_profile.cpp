#include "bake/effects/multiple/medium_profile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/multiple/walks/true_walks.h"
#include "bake/effects/multiple/walks/view_set.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/slab/even_light.h"
#include "bake/plan/plan_input.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::Medium;

Profile make_profile(Medium::Profile kind, bool paper, double sigma_s_prime, double sigma_a,
                     double eta) {
    if (paper) return make_dipole(DipoleKind::classic_fitted, sigma_s_prime, sigma_a, eta);
    if (kind == Medium::Profile::classic) {
        return make_dipole(DipoleKind::classic, sigma_s_prime, sigma_a, eta);
    }
    if (kind == Medium::Profile::beams) return make_beam_diffusion(sigma_s_prime, sigma_a, eta);
    return make_dipole(DipoleKind::better, sigma_s_prime, sigma_a, eta);
}

std::vector<TestLight> make_pilot_lights() {
    constexpr std::array<glm::vec3, 3> kSuns{
        {{0.36f, 0.48f, 0.8f}, {-0.8f, 0.6f, 0}, {0.48f, -0.36f, -0.8f}}};
    constexpr float kSunRadius = 0.0046f;  // [rad]
    const std::size_t texels = formats::cubemap_texels(kTruthCubemap);
    const std::vector<double> solid_angle = formats::texel_solid_angles(kTruthCubemap);
    std::vector<TestLight> lights(1 + kSuns.size());
    for (TestLight& light : lights) {
        light.smooth.assign(texels, 0.0f);
    }
    for (std::size_t j = 0; j < texels; ++j) {
        lights[0].smooth[j] = static_cast<float>(solid_angle[j % solid_angle.size()]);
    }
    for (std::size_t s = 0; s < kSuns.size(); ++s) {
        lights[s + 1].discs.push_back({kSuns[s], kSunRadius, std::numbers::pi});
    }
    return lights;
}

struct Pilot {
    SunRays suns;
    SmoothLights smooth;
    WalkSpace space;
};

// Sums over receivers, views and lights; a product of two independent estimates has no noise on
// average.
struct PilotSquares {
    double error = 0, truth = 0;
    std::uint64_t rays = 0;
};

// `compare`: PilotSquares of a pilot, a point, and its number. Errors up to `noise` are 0.
template <class Compare>
ModelError measure(const EffectInputs& inputs, std::size_t receivers, double noise,
                   std::uint64_t& traced, Compare&& compare) {
    constexpr std::uint32_t kRaysPerSun = 1;
    const std::vector<BodyPoint> points = draw_body_points(inputs, receivers);
    const std::vector<TestLight> lights = make_pilot_lights();
    const Pilot pilot{
        make_sun_rays(lights, kRaysPerSun), make_smooth_lights(lights),
        make_walk_space(inputs.bake.scene, inputs.bake.rays.hierarchy(), inputs.material,
                        inputs.layout.bands() == 1, inner_materials(inputs), meets_others(inputs))};
    PilotSquares sum;
    for_each_block_in_order(
        points.size(), 1, inputs.context,
        [&](Range range) {
            return compare(pilot, points[range.begin], static_cast<std::uint32_t>(range.begin));
        },
        [&](Range, PilotSquares&& part) {
            sum.error += part.error;
            sum.truth += part.truth;
            traced += part.rays;
        });
    if (!(sum.truth > 0)) {
        return {};
    }
    const double error = std::sqrt(std::max(0.0, sum.error / sum.truth));
    return {error > noise ? error : 0, static_cast<std::uint32_t>(points.size())};
}

// `seen`: of each view.
void compare_views(const ViewSet& set, const std::vector<TwoEstimates>& seen,
                   PilotSquares& squares) {
    constexpr double kNormal = 0.25;  // weight of the last view, the normal
    for (std::size_t u = 0; u < seen.size(); ++u) {
        const double weight =
            u + 1 == seen.size() ? kNormal : (1 - kNormal) * static_cast<double>(set.share[u][0]);
        for (std::size_t l = 0; l < seen[u].first.size(); ++l) {
            const auto left = [&](Luminance TwoEstimates::*by) {
                double sum = -(seen[u].*by)[l];
                for (std::size_t v = 0; v < seen.size(); ++v) {
                    sum += static_cast<double>(set.share[v][0]) * (seen[v].*by)[l];
                }
                return sum;
            };
            squares.error += weight * left(&TwoEstimates::first) * left(&TwoEstimates::second);
            squares.truth += weight * seen[u].first[l] * seen[u].second[l];
        }
    }
}

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

MediumProfile make_medium_profile(const Medium& medium) {
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
            profile.all_orders[b] = profile.all_orders[b - 1];
            continue;
        }
        profile.band[b] =
            make_profile(medium.profile, paper, (1 - g) * sigma_s, sigma_a, profile.eta);
        const double total = profile_total(profile.band[b]);
        if (!unscaled && total > 0) {
            const HalfSpaceReflectance returned =
                half_space_reflectance(sigma_s / (sigma_s + sigma_a), g, profile.eta);
            if (normalized) {
                profile.band[b] = make_normalized_diffusion(
                    (returned.once + returned.rest) / escape, profile_length(profile.band[b]),
                    DiffusionLength::mean_free_path_diffuse);
            } else {
                profile.scale[b] = returned.rest / (total * escape);
                if (returned.rest > 0) profile.all_orders[b] += returned.once / returned.rest;
            }
        }
        if (total > 0) {
            smallest = std::min(smallest, profile_length(profile.band[b]));
        }
    }
    profile.smallest = std::isfinite(smallest) ? smallest : 0;
    return profile;
}

std::uint32_t count_samples(double area, double depth, const SampleBudget& budget) {
    // Resolve the shape of a body that light crosses, and shadows on it of its own parts.
    constexpr double kLeastPerPath = 2000, kForShadows = 8000;
    constexpr double kPerReceiver = 5;  // README.md
    const double least = std::min(kLeastPerPath * budget.per_path, budget.most);
    const double wanted = depth > 0 ? std::ceil(budget.per_path * area / (depth * depth)) : 0.0;
    const double shown =
        budget.per_path * std::max(kForShadows, std::ceil(kPerReceiver * budget.receivers));
    return static_cast<std::uint32_t>(std::min(std::clamp(wanted, least, budget.most), shown));
}

ModelError measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                          std::uint64_t& traced) {
    constexpr std::size_t kReceivers = 64;
    constexpr std::uint32_t kFromEach = 512, kPoints = 256;
    const SurfaceIntegral integral =
        make_surface_integral(inputs.bake.scene, inputs.material, profile);
    const auto compare = [&](const Pilot& pilot, const BodyPoint& point, std::uint32_t key) {
        PilotSquares squares;
        const WalkLight light{inputs.outside(), pilot.suns,
                              pilot.smooth,     make_exit_lobe(profile.eta),
                              profile.exit,     kFromEach};
        const TwoEstimates walked =
            walk_to_lights(pilot.space, light, point, {}, inputs.knobs.seed, key, squares.rays);
        const TwoEstimates dipole = integrate_multiple(
            integral, {inputs.bake.scene, inputs.outside(), pilot.suns, pilot.smooth, kPoints},
            point.position, {inputs.knobs.seed, key}, squares.rays);
        for (std::size_t l = 0; l < walked.first.size(); ++l) {
            const double a = walked.first[l], b = walked.second[l];
            squares.error += (dipole.first[l] - a) * (dipole.second[l] - b);
            squares.truth += a * b;
        }
        return squares;
    };
    return measure(inputs, kReceivers, 0, traced, compare);
}

ModelError measure_views(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced) {
    constexpr std::size_t kReceivers = 16;
    constexpr std::uint32_t kFromEach = 32;
    constexpr double kNoise = 0.03;
    const ViewFit fit = make_view_fit(profile.eta);
    const auto compare = [&](const Pilot& pilot, const BodyPoint& point, std::uint32_t number) {
        PilotSquares squares;
        const ViewSet set = make_view_set(fit, profile.eta, point.normal, 1 + kFirstDegree);
        std::vector<TwoEstimates> seen;
        for (const glm::vec3& into : set.into) {
            const WalkLight light{
                inputs.outside(), pilot.suns, pilot.smooth, make_exit_lobe(profile.eta),
                profile.exit,     kFromEach,  -into};
            const auto key = static_cast<std::uint32_t>(number * set.into.size() + seen.size());
            seen.push_back(walk_to_lights(pilot.space, light, point,
                                          {1, false, inputs.layout.fills_crossed,
                                           inputs.layout.layered && inputs.layout.crosses},
                                          inputs.knobs.seed, key, squares.rays));
        }
        compare_views(set, seen, squares);
        return squares;
    };
    return measure(inputs, kReceivers, kNoise, traced, compare);
}

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
