#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/plan/effect.h"
#include "bake/plan/stage_work.h"
#include "formats/scene.h"

namespace opaline::bake {

/// One stage of a bake, named as in run_bake's report.
struct StageCost {
    std::string name;
    /// What it is alike in all scenes that have it: rates are learnt by it.
    std::string kind;
    double work = 0;     ///< [s] of all threads together, of counts and constants alone
    double seconds = 0;  ///< as the clock on the wall shows them on this machine
};

/// The predicted cost of a bake.
struct CostPrediction {
    std::vector<StageCost> stages;   ///< in the order that they run
    double seconds = 0;              ///< of all stages
    double shared_seconds = 0;       ///< part of `seconds` that belongs to no effect
    std::uint64_t bytes = 0;         ///< of the file
    std::uint64_t shared_bytes = 0;  ///< of its mesh and images: part of `bytes`
    std::uint64_t vertices = 0;
    std::uint64_t receivers = 0;     ///< fewer where vertices share rows
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
    const StageRates& rates;
    unsigned threads = 1;          ///< >= 1
    bool receiver_errors = false;  ///< BakeExtras::receiver_errors: bytes of the file alone
    /// RefineReport::rays, which the stage before the plan traced; 0: none.
    std::uint64_t refinement_rays = 0;
};

/// Predicts the bake that `plan` decides on, knobs and all, on a machine of these rates, and fills
/// in the plan's predicted_seconds and predicted_bytes. A pure function of its arguments: a few
/// passes over the scene, no rays. The stages are those of run_bake; each effect counts the work of
/// its own.
///
/// With Knobs::error_target the prediction covers the first round: the pilot, and a bake with the
/// present knobs. The pilot may choose others.
///
/// Counts follow from the numbers of triangles, receivers, samples and texels, and from the ratio
/// of a medium's profile width to the sample spacing. The clutter of a scene is not known:
/// constants are those of a dented ball, and rates tell what earlier bakes took over them.
///
/// Volumes cost what the layouts of plan_volumes ask for; what no entry of `plan` pays is shared.
CostPrediction predict_costs(const CostRequest& request, std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
