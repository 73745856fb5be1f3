#pragma once

#include <array>
#include <span>
#include <string_view>

#include "bake/plan/bake_plan.h"
#include "bake/scene/scene_facts.h"

namespace opaline::bake {

/// Decisions may leave out less radiance than this under `white`.
inline constexpr double kLeastBound = 1.0 / 512;

/// What a rule decides from.
struct PlanInput {
    const formats::Material& material;
    const MaterialFacts& subject;
    const Knobs& knobs;
    /// Radiance below which a row of the plan is left out: kLeastBound, or with Knobs::error_target
    /// a share of it such that all rows of the subject together take at most a quarter.
    double least_bound = kLeastBound;
    std::span<const PlanEntry> earlier{};  ///< decisions on this subject so far
};

/// Whether an effect of this bound is simulated. `forced`: its bound is too small, but
/// Knobs::simulate_all asks for it. Effects of an unknown bound (NaN) are simulated.
bool is_worth(double bound, const PlanInput& input, bool& forced);

/// True if the user named the effect; true if the user did not exclude it.
bool is_named(const Knobs& knobs, std::string_view effect);
bool is_wanted(const Knobs& knobs, std::string_view effect);

/// Coefficients [1/m] of one band of a medium.
struct Band {
    double sigma_s, sigma_a;
};
std::array<Band, 3> bands_of(const formats::Medium& medium);

// Predicates for rules.
bool has_medium(const PlanInput& input);
bool is_any_material(const PlanInput& input);
bool is_thin_walled(const PlanInput& input);

}  // namespace opaline::bake
