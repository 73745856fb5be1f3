#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "bake/plan/bake_plan.h"

namespace opaline::bake {

/// Cube map over which openness is measured for specular reflection.
inline constexpr std::uint32_t kOpennessCubemap = 8;

/// What the rules ask about one material's surfaces.
struct PlanSubject {
    double receivers = 0;
    double area = 0;                     ///< [m^2], of a medium's boundary
    glm::vec3 low{1e30f}, high{-1e30f};  ///< [m], of a medium
    float brightest_vertex = 0;          ///< largest component of its vertex colours
};

struct PlanInput {
    const formats::Material& material;
    const PlanSubject& subject;
    const Knobs& knobs;
};

/// One row of the planner: which materials an effect concerns, and whether it is worth simulating.
/// `decide` fills in everything but effect, subject and material.
struct PlanRule {
    std::string_view effect;
    bool (*applies)(const PlanInput& input);
    PlanEntry (*decide)(const PlanInput& input);
};

/// All rules, in the order in which plans list effects.
extern const std::span<const PlanRule> kPlanRules;

/// The share of single scattering in what a half space returns of uniform light: the largest over
/// the bands. In [0, 1].
double single_share(const formats::Medium& medium);

/// The smallest K whose error, times the share of single scattering, is at most
/// `knobs.phase_tolerance` (translucency.md 9), unless the user gave one.
std::uint32_t choose_terms(const formats::Medium& medium, const Knobs& knobs);

}  // namespace opaline::bake
