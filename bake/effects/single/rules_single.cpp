#include "bake/effects/single/rules_single.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bake/effects/single/single_knobs.h"
#include "bake/physics/phase.h"
#include "bake/physics/phase_series.h"
#include "bake/plan/medium_exitance.h"

namespace opaline::bake {
namespace {

constexpr unsigned kSeriesDegrees = 5;

// Light scattered on a line across the whole body: alpha (1 - e^(-sigma_t d)), largest band.
double largest_scattered_share(const PlanInput& input) {
    const double diagonal =
        static_cast<double>(glm::length(input.subject.high - input.subject.low));
    double share = 0;
    for (const auto& [sigma_s, sigma_a] : bands_of(*input.material.medium)) {
        const double sigma_t = sigma_s + sigma_a;
        if (sigma_t > 0) {
            share = std::max(share, sigma_s / sigma_t * -std::expm1(-sigma_t * diagonal));
        }
    }
    return share;
}

// Whether rows decided on earlier can hold light that scatters once as well.
bool holds_all_orders(const PlanInput& input) {
    return std::ranges::any_of(input.earlier,
                               [](const PlanEntry& e) { return e.on && e.all_orders; });
}

// Whether light goes through other media inside, which straight paths do not.
bool is_layered(const PlanInput& input) {
    return std::ranges::any_of(input.earlier, [](const PlanEntry& e) { return e.on && e.layered; });
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

}  // namespace

PlanEntry decide_single(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PhaseDensity phase = make_phase_density(medium.phase);
    PlanEntry entry;
    entry.has_bands = true;
    double peak = 0;
    for (int i = 0; i <= 64; ++i) {
        peak = std::max(peak, eval_phase(phase, -1 + i / 32.0));
    }
    const auto eta = static_cast<double>(medium.eta);
    entry.bound =
        largest_scattered_share(input) * std::min(1.0, 4 * std::numbers::pi * peak / (eta * eta));
    if (!is_wanted(input.knobs, "single")) {
        entry.reason = "left out by --effects";
    } else if (input.subject.is_buried && !input.knobs.simulate_all) {
        entry.bound = 0;
        entry.reason = "its surface lies inside other media and is not seen";
    } else if ((!input.knobs.separate_terms || is_layered(input)) && holds_all_orders(input)) {
        entry.alternative = entry.all_orders = true;
        entry.reason =
            "random walks follow light that scatters once together with the rest, along its true "
            "path";
    } else if (input.subject.varies) {
        entry.alternative = true;
        entry.all_orders = holds_all_orders(input);
        entry.reason = entry.all_orders
                           ? "random walks follow light that scatters once together with the rest: "
                             "the medium varies in space"
                           : "the medium varies in space: only random walks know it, with multiple "
                             "scattering";
    } else if (medium.profile == formats::Medium::Profile::normalized &&
               medium.fidelity == formats::Medium::Fidelity::physical &&
               !is_named(input.knobs, "single")) {
        entry.reason = "normalised diffusion has the single scattering in it";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the medium hardly scatters";
    } else {
        entry.reason = is_anisotropic(input)
                           ? "light scatters once inside"
                           : "light scatters once inside, alike in all directions: one term, for "
                             "any view";
    }
    return entry;
}

bool is_anisotropic(const PlanInput& input) {
    return input.material.medium &&
           phase_rms(expand_phase(input.material.medium->phase, kSeriesDegrees), 1) > 0;
}

PlanEntry decide_terms(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PhaseSeries series = expand_phase(medium.phase, kSeriesDegrees);
    PlanEntry entry;
    entry.least_terms = 4;
    entry.bound = largest_scattered_share(input) * 4 * std::numbers::pi * phase_rms(series, 1);
    if (!decide_single(input).on) {
        entry.reason = "no light that scatters once is simulated apart";
        return entry;
    }
    const std::uint32_t needed = needed_terms(medium, input.knobs);
    entry.terms = choose_terms(medium, input.knobs);
    if (entry.terms == 1 && input.knobs.simulate_all && whole(input.knobs, kPhaseTerms) == 0) {
        entry.forced = true;
        entry.terms = 4;
    }
    entry.on = entry.terms > 1;
    const auto error_of = [&](std::uint32_t terms) { return percent(once_error(medium, terms)); };
    entry.reason = std::to_string(entry.terms) + (entry.on ? " terms" : " term") +
                   " of the phase function, which leave" + (entry.on ? " " : "s ") +
                   error_of(entry.terms) + " of the light wrong";
    if (entry.on) {
        entry.reason += " instead of " + error_of(1) + ": the rows depend on the view";
    } else {
        entry.reason += ": the rows do not depend on the view";
    }
    if (needed > entry.terms) {
        entry.reason += "; as asked for, it needs " + std::to_string(needed);
    }
    return entry;
}

std::uint32_t needed_terms(const formats::Medium& medium, const Knobs& knobs) {
    const double share = share_scattered_once(medium);
    return share > 0 ? choose_phase_terms(expand_phase(medium.phase, kSeriesDegrees),
                                          knobs[kPhaseTolerance] / share)
                     : 1;
}

std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs) {
    const std::uint32_t given = whole(knobs, kPhaseTerms);
    return given != 0 ? given : needed_terms(medium, knobs);
}

}  // namespace opaline::bake
