#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/measure/check_model.h"
#include "bake/measure/measure_error.h"
#include "bake/pilot/pilot.h"
#include "bake/plan/bake_plan.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

struct StageReport {
    std::string name;
    double seconds = 0;
    std::uint64_t rays = 0;
    std::uint64_t peak_rss_bytes = 0;  ///< of the process so far
};

/// What the pilot of a target error found out.
struct AccuracyReport {
    double target = 0;     ///< relative RMS asked for
    double predicted = 0;  ///< expected of the chosen knobs, before the bake
    double likely = 0;     ///< one standard error of the pilot more
    bool met = false;      ///< expected to, and measured at receivers and between them
    struct Trial {
        std::uint32_t cubemap_size;
        double samples_per_path;
        PilotTrial trial;
    };
    std::vector<Trial> trials;
};

struct BakeResult {
    formats::Asset asset;
    Knobs knobs;
    unsigned threads = 1;  ///< as used
    std::vector<PlanEntry> plan;
    std::vector<StageReport> stages;
    ErrorReport error;
    std::optional<AccuracyReport> accuracy;       ///< where an error was asked for
    std::optional<ModelErrorReport> model_error;  ///< where Knobs::check_model asks for it
    std::vector<formats::Diagnostic> warnings;
    double seconds_total = 0;
};

/// The whole bake: the stages in order, nothing else. `knobs`: as resolve_knobs makes them.
/// Errors: resource, interrupted (the context was cancelled).
formats::Result<BakeResult> run_bake(const formats::Scene& scene, const Knobs& knobs,
                                     const Context& context);

}  // namespace opaline::bake
