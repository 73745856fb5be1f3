#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "bake/plan/bake_plan.h"
#include "bake/scene/scene_facts.h"

namespace opaline::bake {

/// Decisions may leave out less radiance than this under `white`.
inline constexpr double kLeastBound = 1.0 / 512;
/// The same, or with Knobs::error_target a share of it such that all decisions on a subject
/// together leave out at most a quarter.
double least_bound(const Knobs& knobs, std::size_t decisions);

/// State that an effect keeps between its functions; its type is private to the effect.
struct Prepared {
    virtual ~Prepared() = default;
};

/// What a rule decides from.
struct PlanInput {
    const formats::Material& material;
    const MaterialFacts& subject;
    const Knobs& knobs;
    double least_bound = kLeastBound;      ///< of as many decisions as concern the subject
    std::span<const PlanEntry> earlier{};  ///< decisions on this subject so far
    const Prepared* study = nullptr;       ///< the effect's own, of this subject; null: none yet
};

/// Whether an effect of this bound is simulated. `forced`: its bound is too small, but
/// Knobs::simulate_all asks for it. Effects of an unknown bound (NaN) are simulated.
bool is_worth(double bound, const PlanInput& input, bool& forced);

/// A decision on another subject than a material, one of as many `decisions`: on if its bound is
/// not small, or if Knobs::simulate_all asks for it and it is above 0. Its reason is empty unless
/// --effects leaves the effect out. `name`: that of an effect, or effect.part.
PlanEntry decide_by_bound(std::string_view name, const Subject& subject, double bound,
                          std::size_t decisions, const Knobs& knobs);
/// Gives a decision its reason, unless it has one.
void explain(PlanEntry& entry, const std::string& on, const std::string& off);
/// Adds to its reason that it is on in spite of its bound, if it is.
void tell_forced(PlanEntry& entry);

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
