#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/measure_error.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/effects/layers/layer_error.h"
#include "bake/pipeline/choose_knobs.h"
#include "bake/refine/refine_scene.h"
#include "bake/refine/simplify_scene.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Volumes as one quality bakes them, and how far they err.
struct VolumeTrial {
    Quality quality = Quality::draft;
    double error = 0;  ///< VolumeErrorReport::rms_relative
};

struct BakeResult {
    formats::Asset asset;
    std::vector<float> receiver_errors;  ///< one for each receiver, where they are wanted
    Knobs knobs;                         ///< as used
    unsigned threads = 1;                ///< as used
    std::vector<PlanEntry> plan;         ///< as ScenePlan::entries, with what the stages found
    SceneFacts facts;                    ///< that the plan was decided from
    RefineReport refinement;
    SimplifyReport simplification;  ///< given 0: not asked for
    std::optional<formats::Scene>
        scene;  ///< with the receivers that were added; none were: nothing
    StageLog stages;
    ErrorReport error;
    std::optional<AccuracyReport> accuracy;         ///< where an error was asked for
    std::optional<ModelErrorReport> model_error;    ///< where Knobs::check_model asks for it
    std::optional<VolumeErrorReport> volume_error;  ///< nothing: no volume scatters light
    std::optional<LayerErrorReport> layer_error;    ///< nothing: the file has no cloud layer
    std::vector<std::string> glowing_volumes;  ///< wanted names of the emitters that volumes are
    std::vector<VolumeTrial> volume_trials;    ///< where an error was asked for, in their order
    std::vector<formats::Diagnostic> warnings;
    double seconds_total = 0;
};

/// What a bake is asked for that changes nothing else in it.
struct BakeExtras {
    bool receiver_errors = false;  ///< what encoding costs each receiver (receiver_error.h)
    /// Called once the plan is there, before anything is traced, with the scene that it is of; may
    /// be empty. Studies may still change decisions.
    std::function<void(const formats::Scene&, const BakeResult&)> on_planned = {};
};

/// The whole bake: the stages in order, nothing else. `knobs`: as resolve_knobs makes them for the
/// same table.
/// Errors: resource, interrupted (the context was cancelled).
formats::Result<BakeResult> run_bake(const EffectTable& effects, const formats::Scene& scene,
                                     const Knobs& knobs, const Context& context,
                                     const BakeExtras& extras = {});

}  // namespace opaline::bake
