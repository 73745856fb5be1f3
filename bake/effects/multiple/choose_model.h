#pragma once

#include <cstdint>
#include <string>

#include "bake/effects/multiple/multiple_stage.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// A share in words, "3.1 %".
std::string percent(double error);

/// Relative RMS that a model may err by where none is asked for: half of the square of
/// Knobs::error_target; without one, as the quality allows; of draft and preview infinite, they are
/// for the eye.
double allowed_model_error(const Knobs& knobs);

/// Whether random walks are expected: asked for, or the dipole errs by more than is allowed, by
/// estimate. What is chosen in the end is measured (choose_model).
bool expects_walks(const formats::Medium& medium, const MaterialFacts& body, const Knobs& knobs);

/// What the models err by in one body.
struct ModelErrors {
    double dipole = 0, scaled = 0;  ///< relative RMS of multiple scattering
    std::uint32_t receivers = 0;    ///< at which it was measured; 0: it was not
};

/// The model of a body's multiple scattering.
struct ModelChoice {
    MultipleModel model = MultipleModel::dipole;  ///< not automatic
    ModelErrors errors;
    /// Relative RMS that the dipole, measured or else estimated, or the scaled dipole, measured,
    /// errs by, as a share of multiple scattering alone.
    double error = 0;
    bool all_orders = false;  ///< walks may follow light scattered once as well
};

/// Compares the dipole, and the dipole scaled to walks under even light, with random walks at some
/// receivers, under a white sky and three suns of its own: all three by Monte Carlo, each estimated
/// twice, so that noise does not count. `traced` adds up.
ModelErrors measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                           std::uint64_t& traced);

/// The model asked for; automatic: the dipole where its error is allowed, by estimate or as
/// measured, else the scaled dipole where its error is, else walks.
ModelChoice choose_model(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced);

/// The rule `multiple.model`.
PlanEntry decide_model(const PlanInput& input);

/// The decision once the choice is made.
void describe_choice(const ModelChoice& choice, PlanEntry& entry);

}  // namespace opaline::bake
