#include "bake/effects/multiple/choose_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/multiple/walk_costs.h"
#include "bake/effects/multiple/walks/true_walks.h"
#include "bake/truth/draw_receivers.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// White, and three suns that see each body from different sides.
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

// Receivers of the material, spread over it.
std::vector<BodyPoint> draw_points(const EffectInputs& inputs, std::size_t count) {
    std::vector<BodyPoint> all;
    for (const ReceiverSet& set : inputs.bake.receivers) {
        if (set.material == inputs.material) {
            for (const BodyPoint& point : set.inside) {
                if (point.normal != glm::vec3(0)) {
                    all.push_back(point);
                }
            }
        }
    }
    std::vector<BodyPoint> drawn;
    for (const std::uint32_t v : draw_evenly(static_cast<std::uint32_t>(all.size()), count,
                                             RandomStage::pilot_receivers, inputs.knobs.seed)) {
        drawn.push_back(all[v]);
    }
    return drawn;
}

// Sums over receivers and lights; a product of two independent estimates has no noise on average.
struct Squares {
    double dipole = 0, scaled = 0, truth = 0;
};

Squares compare(const TwoEstimates& walked, const TwoEstimates& dipole) {
    Squares squares;
    const auto scale = [](const Luminance& to, const Luminance& from) {
        return from[0] > 0 ? to[0] / from[0] : 1;
    };
    const double first = scale(walked.first, dipole.first);
    const double second = scale(walked.second, dipole.second);
    for (std::size_t l = 0; l < walked.first.size(); ++l) {
        const double a = walked.first[l], b = walked.second[l];
        squares.dipole += (dipole.first[l] - a) * (dipole.second[l] - b);
        squares.scaled += (first * dipole.first[l] - a) * (second * dipole.second[l] - b);
        squares.truth += a * b;
    }
    return squares;
}

double expected_error(const formats::Medium& medium, const MaterialFacts& body) {
    const double length = transport_mean_free_path(medium);
    if (!(length > 0)) {
        return 0;
    }
    // An open body may be a sheet: it is measured.
    return body.is_closed() && body.area > 0
               ? half_space_error(4 * std::abs(body.volume) / body.area / length)
               : half_space_error(0);
}

// Sites so far apart that they hold what the dipole lacks blur light that scatters once. Where its
// phase function is peaked, terms in the view err by more (tests/bench/RESULTS.md, "Walks").
bool hold_all_orders(const formats::Medium& medium, const MaterialFacts& body, const Knobs& knobs) {
    constexpr double kPeaked = 0.5;
    return transport_mean_free_path(medium) > 0 && body.area > 0 &&
           (!expected_sites(medium, body, knobs).is_residual ||
            std::abs(formats::mean_cosine(medium.phase)) >= kPeaked);
}

// A profile that the user chose is meant.
bool is_fixed(const formats::Medium& medium) {
    return medium.profile != formats::Medium::Profile::automatic ||
           medium.fidelity == formats::Medium::Fidelity::paper;
}

}  // namespace

std::string percent(double error) {
    const std::string text = std::to_string(1e-1 * std::round(1e3 * error));
    return text.substr(0, text.find('.') + 2) + " %";
}

double allowed_model_error(const Knobs& knobs) {
    return knobs.error_target > 0                 ? std::numbers::sqrt2 / 2 * knobs.error_target
           : knobs.quality == Quality::reference  ? 0.005
           : knobs.quality == Quality::production ? 0.02
                                                  : std::numeric_limits<double>::infinity();
}

bool expects_walks(const formats::Medium& medium, const MaterialFacts& body, const Knobs& knobs) {
    const auto asked = static_cast<MultipleModel>(whole(knobs, kMultipleModel));
    return asked == MultipleModel::automatic
               ? !is_fixed(medium) && expected_error(medium, body) > allowed_model_error(knobs)
               : asked != MultipleModel::dipole;
}

ModelErrors measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                           std::uint64_t& traced) {
    constexpr std::size_t kReceivers = 64;
    constexpr std::uint32_t kFromEach = 512, kPoints = 256, kRaysPerSun = 1;
    const std::vector<BodyPoint> points = draw_points(inputs, kReceivers);
    const std::vector<TestLight> lights = make_pilot_lights();
    const SunRays suns = make_sun_rays(lights, kRaysPerSun);
    const SmoothLights smooth = make_smooth_lights(lights);
    const WalkSpace space = make_walk_space(inputs.bake.scene, inputs.bake.rays.hierarchy(),
                                            inputs.material, inputs.layout.bands() == 1);
    const WalkLight walk_light{inputs.outside(), suns,     smooth, make_exit_lobe(profile.eta),
                               profile.exit,     kFromEach};
    const SurfaceIntegral integral =
        make_surface_integral(inputs.bake.scene, inputs.material, profile);
    struct Part {
        Squares squares;
        std::uint64_t rays = 0;
    };
    Squares sum;
    for_each_block_in_order(
        points.size(), 1, inputs.context,
        [&](Range range) {
            Part part;
            const BodyPoint& point = points[range.begin];
            const auto key = static_cast<std::uint32_t>(range.begin);
            part.squares = compare(
                walk_to_lights(space, walk_light, point, {}, inputs.knobs.seed, key, part.rays),
                integrate_multiple(integral,
                                   {inputs.bake.scene, inputs.outside(), suns, smooth, kPoints},
                                   point.position, {inputs.knobs.seed, key}, part.rays));
            return part;
        },
        [&](Range, Part&& part) {
            sum.dipole += part.squares.dipole;
            sum.scaled += part.squares.scaled;
            sum.truth += part.squares.truth;
            traced += part.rays;
        });
    if (!(sum.truth > 0)) {
        return {};
    }
    return {std::sqrt(std::max(0.0, sum.dipole / sum.truth)),
            std::sqrt(std::max(0.0, sum.scaled / sum.truth)),
            static_cast<std::uint32_t>(points.size())};
}

ModelChoice choose_model(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced) {
    const auto asked = static_cast<MultipleModel>(whole(inputs.knobs, kMultipleModel));
    const MaterialFacts& body = inputs.bake.facts.material[inputs.material];
    const bool is_auto = asked == MultipleModel::automatic;
    const bool may_hold = hold_all_orders(inputs.medium(), body, inputs.knobs);
    const double expected = expected_error(inputs.medium(), body);
    const double allowed = allowed_model_error(inputs.knobs);
    ModelChoice choice;
    choice.model = is_auto ? MultipleModel::dipole : asked;
    choice.all_orders = may_hold && !inputs.layout.at_entry;
    // Peaked media may leave this layout once light scattered once has terms of its own.
    const bool is_measured = is_auto
                                 ? expects_walks(inputs.medium(), body, inputs.knobs) &&
                                       (may_hold || !inputs.layout.at_entry)
                                 : inputs.knobs.error_target > 0 && !is_fixed(inputs.medium()) &&
                                       asked != MultipleModel::walks && expected > allowed;
    if (is_measured) {
        choice.errors = measure_models(inputs, profile, traced);
    }
    const ModelErrors& errors = choice.errors;
    if (is_auto && errors.receivers > 0) {
        choice.model = errors.dipole <= allowed   ? MultipleModel::dipole
                       : errors.scaled <= allowed ? MultipleModel::scaled
                                                  : MultipleModel::walks;
    }
    if (choice.model == MultipleModel::dipole) {
        choice.error = errors.receivers > 0 ? errors.dipole : expected;
    } else if (choice.model == MultipleModel::scaled) {
        choice.error = errors.scaled;
    }
    return choice;
}

PlanEntry decide_model(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    entry.alternative = true;
    const double error = expected_error(medium, input.subject);
    // The rule before this one is the effect's own.
    const PlanEntry& effect = input.earlier.back();
    entry.bound = effect.on ? error * effect.bound : 0;
    const auto asked = static_cast<MultipleModel>(whole(input.knobs, kMultipleModel));
    const double allowed = allowed_model_error(input.knobs);
    if (asked != MultipleModel::automatic) {
        entry.on = asked != MultipleModel::dipole;
        entry.reason = std::string(kMultipleModel.words[static_cast<std::size_t>(asked)]) +
                       ": as --multiple-model says";
    } else if (is_fixed(medium)) {
        entry.reason = "dipole: the medium names its profile";
    } else if (!std::isfinite(allowed)) {
        entry.reason = "dipole: " + std::string(quality_name(input.knobs.quality)) +
                       " takes every surface for that of a half space, which errs by some " +
                       percent(error);
    } else if (error <= allowed || !effect.on) {
        entry.reason = "dipole: the body is so thick that it errs by some " + percent(error);
    } else {
        entry.on = true;
        entry.reason =
            "measured before the bake: the dipole, or random walks where it errs by "
            "more than " +
            percent(allowed);
    }
    if (effect.on) {
        entry.choice = asked != MultipleModel::automatic
                           ? kMultipleModel.words[static_cast<std::size_t>(asked)]
                       : entry.on ? std::string_view()
                                  : "dipole";
    }
    entry.model_error = effect.on && !entry.on ? error : 0;
    entry.all_orders = effect.on && entry.on && asked != MultipleModel::scaled &&
                       hold_all_orders(medium, input.subject, input.knobs);
    return entry;
}

void describe_choice(const ModelChoice& choice, PlanEntry& entry) {
    entry.choice = kMultipleModel.words[static_cast<std::size_t>(choice.model)];
    const bool was_on = std::exchange(entry.on, choice.model != MultipleModel::dipole);
    entry.all_orders = choice.model == MultipleModel::walks && choice.all_orders;
    entry.model_error = choice.error;
    if (choice.errors.receivers == 0) {
        entry.reason = was_on && !entry.on ? "dipole: light leaves where it entered" : entry.reason;
        return;
    }
    entry.reason =
        std::string(entry.choice) + ": measured at " + std::to_string(choice.errors.receivers) +
        " vertices, the dipole differs from random walks by " + percent(choice.errors.dipole) +
        ", scaled to them by " + percent(choice.errors.scaled);
}

}  // namespace opaline::bake
