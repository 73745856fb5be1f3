#include "bake/plan/plan_rules.h"

#include <algorithm>

#include "bake/plan/rule_colour.h"
#include "bake/plan/rule_multiple.h"
#include "bake/plan/rule_spread.h"
#include "bake/plan/rules_single.h"
#include "bake/plan/rules_visibility.h"

namespace opaline::bake {
namespace {

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
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the base colour is black, or nearly: nothing is reflected";
    } else {
        entry.reason = medium ? "the medium is shown as a diffuse surface of the same reflectance"
                              : "the surface reflects diffusely";
    }
    return entry;
}

PlanEntry decide_specular(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    // At grazing angles everything is reflected, where there is a boundary at all.
    entry.bound = medium.eta == 1 ? 0 : 1;
    if (!is_wanted(input.knobs, "specular")) {
        entry.reason = "left out by --effects";
    } else if (is_comparison(input.knobs)) {
        entry.reason = "the medium is shown as a diffuse surface, for comparison";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the index of refraction is that of the air: nothing is mirrored";
    } else {
        entry.reason = "the boundary of the medium mirrors its surroundings";
    }
    return entry;
}

constexpr std::array<PlanRule, 8> kRules{{{"direct", any_material, decide_direct},
                                          {"light.visibility", any_material, decide_visibility},
                                          {"multiple", has_medium, decide_multiple},
                                          {"multiple.spread", has_medium, decide_spread},
                                          {"single", has_medium, decide_single},
                                          {"single.terms", is_anisotropic, decide_terms},
                                          {"light.colour", has_medium, decide_colour},
                                          {"specular", has_medium, decide_specular}}};

}  // namespace

const std::span<const PlanRule> kPlanRules = kRules;

bool is_named(const Knobs& knobs, std::string_view effect) {
    return std::find(knobs.effects.begin(), knobs.effects.end(), effect) != knobs.effects.end();
}

bool is_wanted(const Knobs& knobs, std::string_view effect) {
    return knobs.effects.empty() || is_named(knobs, effect);
}

std::array<Band, 3> bands_of(const formats::Medium& medium) {
    const auto band = [](float s, float a) {
        return Band{static_cast<double>(s), static_cast<double>(a)};
    };
    return {band(medium.sigma_s.r, medium.sigma_a.r), band(medium.sigma_s.g, medium.sigma_a.g),
            band(medium.sigma_s.b, medium.sigma_a.b)};
}

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

}  // namespace opaline::bake
