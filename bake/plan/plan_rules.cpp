#include "bake/plan/plan_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/plan/rule_colour.h"
#include "bake/plan/rule_spread.h"
#include "bake/plan/rules_visibility.h"
#include "bake/plan/stage_costs.h"
#include "bake/scattering/dipole.h"
#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_single.h"
#include "bake/scattering/phase.h"
#include "bake/scattering/phase_series.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

bool is_named(const Knobs& knobs, std::string_view effect) {
    return std::find(knobs.effects.begin(), knobs.effects.end(), effect) != knobs.effects.end();
}

bool is_wanted(const Knobs& knobs, std::string_view effect) {
    return knobs.effects.empty() || is_named(knobs, effect);
}

std::array<std::array<double, 2>, 3> bands_of(const formats::Medium& medium) {
    const auto pair = [](float s, float a) {
        return std::array{static_cast<double>(s), static_cast<double>(a)};
    };
    return {pair(medium.sigma_s.r, medium.sigma_a.r), pair(medium.sigma_s.g, medium.sigma_a.g),
            pair(medium.sigma_s.b, medium.sigma_a.b)};
}

bool has_medium(const PlanInput& input) {
    return input.material.medium.has_value();
}

bool any_material(const PlanInput&) {
    return true;
}

// A medium is shaded as a diffuse surface only for comparison: if `direct` is named and nothing
// else is.
bool is_comparison(const Knobs& knobs) {
    return is_named(knobs, "direct") && !is_named(knobs, "multiple") && !is_named(knobs, "single");
}

PlanEntry decide_direct(const PlanInput& input) {
    PlanEntry entry;
    // Under `white` a diffuse surface sends back at most its albedo.
    const formats::Rgb c = input.material.base_color;
    entry.bound = static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex);
    const bool medium = input.material.medium.has_value();
    if (medium && !is_comparison(input.knobs)) {
        entry.bound = 0;
        entry.reason = "light enters the medium instead of being reflected diffusely";
    } else if (!is_wanted(input.knobs, "direct")) {
        entry.reason = "left out by --effects";
    } else if (entry.bound > 0 || input.knobs.simulate_all) {
        entry.on = true;
        entry.forced = !(entry.bound > 0);
        entry.reason = entry.forced ? "the base colour is black: nothing is reflected"
                       : medium ? "the medium is shown as a diffuse surface of the same reflectance"
                                : "the surface reflects diffusely";
    } else {
        entry.reason = "the base colour is black: nothing is reflected";
    }
    return entry;
}

}  // namespace

PlanEntry decide_multiple(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    const double g = formats::mean_cosine(medium.phase);
    double densest = 0;
    for (const auto& [sigma_s, sigma_a] : bands_of(medium)) {
        const double reduced = (1 - g) * sigma_s;
        // Through a thin body light can come from both sides.
        entry.bound = std::max(entry.bound,
                               2 * dipole_total(make_dipole(DipoleKind::classic, reduced, sigma_a,
                                                            static_cast<double>(medium.eta))));
        densest = std::max(densest, reduced + sigma_a);
    }
    if (!is_wanted(input.knobs, "multiple")) {
        entry.reason = "left out by --effects";
        return entry;
    }
    entry.on = is_worth(entry.bound, input, entry.forced);
    if (!entry.on) {
        entry.reason = "the medium absorbs nearly all that it scatters";
        return entry;
    }
    const double samples = expected_samples(medium, input.subject.area, input.knobs);
    entry.reason = "light scatters many times inside; " +
                   std::to_string(static_cast<std::uint64_t>(samples)) + " surface samples";
    return entry;
}

PlanEntry decide_single(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PhaseDensity phase = make_phase_density(medium.phase);
    PlanEntry entry;
    const double diagonal =
        static_cast<double>(glm::length(input.subject.high - input.subject.low));
    double peak = 0;
    for (int i = 0; i <= 64; ++i) {
        peak = std::max(peak, eval_phase(phase, -1 + i / 32.0));
    }
    const auto eta = static_cast<double>(medium.eta);
    for (const auto& [sigma_s, sigma_a] : bands_of(medium)) {
        const double sigma_t = sigma_s + sigma_a;
        if (sigma_t > 0) {
            entry.bound =
                std::max(entry.bound, sigma_s / sigma_t * -std::expm1(-sigma_t * diagonal) *
                                          std::min(1.0, 4 * std::numbers::pi * peak / (eta * eta)));
        }
    }
    if (!is_wanted(input.knobs, "single")) {
        entry.reason = "left out by --effects";
        return entry;
    }
    if (medium.profile == formats::Medium::Profile::normalized &&
        medium.fidelity == formats::Medium::Fidelity::physical &&
        !is_named(input.knobs, "single")) {
        entry.reason = "normalised diffusion has the single scattering in it";
        return entry;
    }
    entry.on = is_worth(entry.bound, input, entry.forced);
    if (!entry.on) {
        entry.reason = "the medium hardly scatters";
        return entry;
    }
    entry.terms = choose_terms(medium, input.knobs);
    entry.reason = entry.terms == 1 ? "light scatters once inside, alike in all directions"
                                    : "light scatters once inside; " + std::to_string(entry.terms) +
                                          " terms of the phase function";
    if (const std::uint32_t needed = needed_terms(medium, input.knobs); needed > entry.terms) {
        entry.reason += ", as asked for; it needs " + std::to_string(needed);
    }
    return entry;
}

namespace {

PlanEntry decide_specular(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    // At grazing angles everything is reflected, where there is a boundary at all.
    entry.bound = medium.eta == 1 ? 0 : 1;
    if (is_comparison(input.knobs) || !is_wanted(input.knobs, "specular")) {
        entry.reason = "left out by --effects";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the index of refraction is that of the air: nothing is mirrored";
    } else {
        entry.reason = "the boundary of the medium mirrors its surroundings";
    }
    return entry;
}

constexpr std::array<PlanRule, 7> kRules{{{"direct", any_material, decide_direct},
                                          {"light.visibility", any_material, decide_visibility},
                                          {"multiple", has_medium, decide_multiple},
                                          {"multiple.spread", has_medium, decide_spread},
                                          {"single", has_medium, decide_single},
                                          {"light.colour", has_medium, decide_colour},
                                          {"specular", has_medium, decide_specular}}};

}  // namespace

const std::span<const PlanRule> kPlanRules = kRules;

bool is_worth(double bound, const PlanInput& input, bool& forced) {
    // Four of a material's rows may be left out: together they take a quarter of the error at most.
    constexpr double kShareOfError = 1.0 / 16;
    const double error = input.knobs.error_target;
    // An unknown bound (NaN) is none.
    const bool worth =
        !(bound < (error > 0 ? std::min(kLeastBound, kShareOfError * error) : kLeastBound));
    forced = input.knobs.simulate_all && !worth;
    return worth || forced;
}

double single_share(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    const auto eta = static_cast<double>(medium.eta);
    const double once = half_space_single(eta), escape = 1 - fresnel_moments(eta).external;
    double share = 0;
    for (const auto& [sigma_s, sigma_a] : bands_of(medium)) {
        if (sigma_s > 0) {
            const double single = once * sigma_s / (sigma_s + sigma_a);
            const double multiple =
                escape *
                dipole_total(make_dipole(DipoleKind::better, (1 - g) * sigma_s, sigma_a, eta));
            share = std::max(share, single / (single + multiple));
        }
    }
    return share;
}

std::uint32_t needed_terms(const formats::Medium& medium, const Knobs& knobs) {
    constexpr unsigned kDegrees = 5;
    const double share = single_share(medium);
    return share > 0 ? choose_phase_terms(expand_phase(medium.phase, kDegrees),
                                          knobs.phase_tolerance / share)
                     : 1;
}

std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs) {
    return knobs.phase_terms != 0 ? knobs.phase_terms : needed_terms(medium, knobs);
}

}  // namespace opaline::bake
