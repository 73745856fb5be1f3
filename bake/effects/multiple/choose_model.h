#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/plan/effect.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// A share in words, "3.1 %".
std::string percent(double error);

/// A share of Knobs::error_target; without a target, by quality from draft to reference.
double allowed_error(const Knobs& knobs, double share, const std::array<double, 4>& by_quality);

/// Largest relative RMS error of an automatically chosen model: half of the square of
/// Knobs::error_target; without a target, by quality.
double allowed_model_error(const Knobs& knobs);

/// The mean cosine is 0.5 or more, either way: light scattered once depends on the view by more
/// than few terms hold.
bool scatters_in_peak(const formats::Medium& medium);

/// Whether models are compared before the bake (measure_models), instead of estimated.
bool measures_models(const Knobs& knobs);

/// Whether random walks are expected: requested, or the dipole's estimated error exceeds the
/// allowed one, or the body contains other media (`layered`). choose_model may decide otherwise.
bool expects_walks(const formats::Medium& medium, const MaterialFacts& body, bool layered,
                   const Knobs& knobs);

/// The model of a body's multiple scattering.
struct ModelChoice {
    MultipleModel model = MultipleModel::dipole;  ///< not automatic
    ModelError dipole;                            ///< by measure_models, where it is asked for
    ModelError views;         ///< of walks, where the number of rows is ours to choose
    bool is_found = false;    ///< dipole_error comes from rays through the body (body_error)
    double dipole_error = 0;  ///< relative RMS, as a share of multiple scattering alone: estimated,
                              ///< found, or measured
    bool all_orders = false;  ///< walks may follow light scattered once as well
    double walks_error =
        0;  ///< relative RMS of walks, where known: of media that scatter in a peak

    /// Error of the chosen model.
    double error() const { return model == MultipleModel::dipole ? dipole_error : walks_error; }
};

/// The model asked for; automatic: the dipole where its error is allowed, else walks. The error is
/// measured, but estimated where that is enough: of thick bodies, and at draft and preview.
ModelChoice choose_model(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced);

/// Whether walks of all orders carry the light of emitters through a medium, whatever model the
/// environment's light has. No other effect adds its single scattering; where sites are far apart
/// they blur it. False where the user chose another model or a profile.
bool takes_walks_alone(const formats::Medium& medium, const RowLayout& layout, const Knobs& knobs);

/// The rule `multiple.model`.
PlanEntry decide_model(const PlanInput& input);

/// The decision once the choice is made.
void describe_choice(const ModelChoice& choice, PlanEntry& entry);

/// A warning where a thousandth or more of the light of a material's walks ends before it leaves
/// the surface: how much, why, and how it is corrected (WalkCounts::correction). `material`: its
/// name.
std::optional<formats::Diagnostic> describe_unfinished(const std::string& material,
                                                       const WalkCounts& counts);

}  // namespace opaline::bake
