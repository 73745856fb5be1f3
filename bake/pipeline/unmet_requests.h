#pragma once

#include <optional>
#include <vector>

#include "bake/plan/effect.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Refuses (usage) a list of effects that concerns no surface of the scene.
formats::Status check_effects(const EffectTable& effects, const formats::Scene& scene,
                              const Knobs& knobs);

/// What was decided.
struct DecidedBake {
    const EffectTable& effects;
    const formats::Scene& scene;
    const SceneFacts& facts;
    const Knobs& knobs;  ///< as they were used
    std::span<const PlanEntry> plan;
};

/// That models err by more than was asked for; nothing: they do not, or `target` is 0.
std::optional<formats::Diagnostic> describe_missed_models(double target, double model);

/// Warnings that decisions call for before anything is traced: knobs that they contradict, and an
/// error that was asked for and is out of their reach.
std::vector<formats::Diagnostic> describe_early(const DecidedBake& decided);

/// Warnings about requests that were not met or have no effect, with the decision made instead.
/// describe_early's are the last.
std::vector<formats::Diagnostic> describe_unmet(const DecidedBake& decided,
                                                const BakeOptions& options);

}  // namespace opaline::bake
