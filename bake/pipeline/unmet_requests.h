#pragma once

#include <vector>

#include "bake/plan/effect.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Refuses (usage) a list of effects of which none concerns any surface of the scene: nothing would
/// be simulated.
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

/// Warnings for what was asked for and is not there in the end, or does nothing, with what was
/// decided instead.
std::vector<formats::Diagnostic> describe_unmet(const DecidedBake& decided,
                                                const BakeOptions& options);

}  // namespace opaline::bake
