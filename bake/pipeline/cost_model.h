#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/plan/effect.h"
#include "bake/plan/rates.h"
#include "formats/scene.h"

namespace opaline::bake {

/// One stage of a bake, named as in run_bake's report.
struct StageCost {
    std::string name;
    double seconds = 0;
};

/// What a bake is going to cost.
struct CostPrediction {
    std::vector<StageCost> stages;   ///< in the order that they run
    double seconds = 0;              ///< of all stages
    double shared_seconds = 0;       ///< of what belongs to no effect: part of `seconds`
    std::uint64_t bytes = 0;         ///< of the file
    std::uint64_t shared_bytes = 0;  ///< of its mesh and images: part of `bytes`
    std::uint64_t receivers = 0;
    std::uint64_t memory_bytes = 0;  ///< peak of the bake (predict_memory.h)
};

/// Bytes of one row of a receiver in the file, of `bands` bands.
std::uint64_t row_bytes(const Knobs& knobs, bool translucent, std::uint64_t bands);

/// What a prediction is made from.
struct CostRequest {
    const EffectTable& effects;
    const formats::Scene& scene;
    const SceneFacts& facts;
    const Knobs& knobs;
    const Rates& rates;
    unsigned threads = 1;  ///< >= 1
};

/// Predicts the bake that `plan` decides on, knobs and all, on a machine of these rates, and fills
/// in the plan's predicted_seconds and predicted_bytes. A pure function of its arguments: a few
/// passes over the scene, no rays. The stages are those of run_bake; each effect counts the work of
/// its own.
///
/// With Knobs::error_target it is the first round: the pilot, and a bake with the knobs as they
/// are. The pilot may choose others.
///
/// Counts are derived from numbers of triangles, receivers, samples and texels, and from how wide a
/// medium's profile is against its samples. How cluttered a scene is, is not known here: rates are
/// those of a dented ball, and scenes differ from it by up to 1.4 either way.
CostPrediction predict_costs(const CostRequest& request, std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
