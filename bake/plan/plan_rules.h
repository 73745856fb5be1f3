#pragma once

#include <array>
#include <span>
#include <string_view>

#include "bake/plan/bake_plan.h"
#include "bake/plan/scene_facts.h"

namespace opaline::bake {

/// Effects that contribute less radiance under `white` are not simulated (translucency.md 9).
inline constexpr double kLeastBound = 1.0 / 512;

/// Cube map over which openness is measured for specular reflection.
inline constexpr std::uint32_t kOpennessCubemap = 8;

struct PlanInput {
    const formats::Material& material;
    const MaterialFacts& subject;
    const Knobs& knobs;
};

/// One row of the planner: which materials an effect concerns, and whether it is worth simulating.
/// `decide` fills in everything but effect, subject and material.
struct PlanRule {
    std::string_view effect;
    bool (*applies)(const PlanInput& input);
    PlanEntry (*decide)(const PlanInput& input);
};

/// Whether an effect of this bound is worth simulating: at least kLeastBound, or a sixteenth of
/// Knobs::error_target where that is less. `forced`: it is not, but Knobs::simulate_all wants it.
bool is_worth(double bound, const PlanInput& input, bool& forced);

/// All rules, in the order in which plans list effects.
extern const std::span<const PlanRule> kPlanRules;

/// Whether the user named the effect; whether they did not rule it out.
bool is_named(const Knobs& knobs, std::string_view effect);
bool is_wanted(const Knobs& knobs, std::string_view effect);

/// Coefficients [1/m] of one band of a medium.
struct Band {
    double sigma_s, sigma_a;
};
std::array<Band, 3> bands_of(const formats::Medium& medium);

}  // namespace opaline::bake
