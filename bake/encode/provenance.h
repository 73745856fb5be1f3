#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/measure/check_model.h"
#include "bake/measure/measure_error.h"
#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The knobs and the measured error, as provenance and report state them.
nlohmann::ordered_json knobs_json(const Knobs& knobs);
nlohmann::ordered_json error_json(const ErrorReport& error);
/// Without the seconds, which differ from run to run.
nlohmann::ordered_json model_error_json(const ModelErrorReport& error);

/// The PROV section as JSON: scene, knobs, plan and measured error. It contains nothing that
/// differs between two runs of the same bake: no seconds, dates, paths or thread counts.
std::string make_provenance(const formats::Scene& scene, const Knobs& knobs,
                            const std::vector<PlanEntry>& plan, const ErrorReport& error,
                            const std::optional<ModelErrorReport>& model_error,
                            std::string_view ray_tracer);

}  // namespace opaline::bake
