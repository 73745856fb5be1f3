#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/check/check_model.h"
#include "bake/check/measure_error.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/effects/layers/layer_error.h"
#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

struct BakeResult;

/// The knobs and the measured error, as provenance and report state them.
nlohmann::ordered_json knobs_json(const Knobs& knobs);
nlohmann::ordered_json error_json(const ErrorReport& error);
/// Without the seconds, which differ from run to run.
nlohmann::ordered_json model_error_json(const ModelErrorReport& error);
nlohmann::ordered_json volume_error_json(const VolumeErrorReport& error);
nlohmann::ordered_json layer_error_json(const LayerErrorReport& error);

/// Adds `model_error`, `volume_error` and `layer_error` of a bake, as far as they were measured.
void add_other_errors(const BakeResult& result, nlohmann::ordered_json& json);

/// What traces rays, with its version.
std::string ray_tracer_name();

/// The PROV section as JSON: scene, knobs, plan and measured error. It contains nothing that
/// differs between two runs of the same bake: no seconds, dates, paths or thread counts.
std::string make_provenance(const formats::Scene& scene, const BakeResult& result);

}  // namespace opaline::bake
