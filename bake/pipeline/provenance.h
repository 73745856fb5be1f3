#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "bake/accuracy/check_model.h"
#include "bake/accuracy/measure_error.h"
#include "bake/accuracy/volumes/volume_error.h"
#include "bake/layers/layer_error.h"
#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The knobs and the measured error, as provenance and report state them.
nlohmann::ordered_json knobs_json(const Knobs& knobs);
nlohmann::ordered_json error_json(const ErrorReport& error);
/// Without the seconds, which differ from run to run.
nlohmann::ordered_json model_error_json(const ModelErrorReport& error);
nlohmann::ordered_json volume_error_json(const VolumeErrorReport& error);
nlohmann::ordered_json layer_error_json(const LayerErrorReport& error);

/// What became of a bake.
struct BakeRecord {
    const Knobs& knobs;
    std::span<const PlanEntry> plan, volume_plan;
    const ErrorReport& error;
    const ModelErrorReport* model_error = nullptr;    ///< null: not measured
    const VolumeErrorReport* volume_error = nullptr;  ///< null: no volume scatters light
    const LayerErrorReport* layer_error = nullptr;    ///< null: the file has no cloud layer
    std::span<const formats::LayerRecord> layers = {};
};

/// The PROV section as JSON: scene, knobs, plan and measured error. It contains nothing that
/// differs between two runs of the same bake: no seconds, dates, paths or thread counts.
std::string make_provenance(const formats::Scene& scene, const BakeRecord& record);

}  // namespace opaline::bake
