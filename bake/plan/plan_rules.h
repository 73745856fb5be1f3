#pragma once

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

/// The rules of the two effects that fill the rows of a medium.
PlanEntry decide_multiple(const PlanInput& input);
PlanEntry decide_single(const PlanInput& input);

/// All rules, in the order in which plans list effects.
extern const std::span<const PlanRule> kPlanRules;

/// The share of single scattering in what a half space returns of uniform light: the largest over
/// the bands. In [0, 1].
double single_share(const formats::Medium& medium);

/// The smallest K whose error, times the share of single scattering, is at most
/// `knobs.phase_tolerance` (translucency.md 9).
std::uint32_t needed_terms(const formats::Medium& medium, const Knobs& knobs);

/// The same, unless the user gave one.
std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs);

}  // namespace opaline::bake
