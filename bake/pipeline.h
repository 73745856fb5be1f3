#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/base/context.h"
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

/// Numerical error of the finished rows against dense, unquantised transport at twice the cube map
/// resolution, over held-back receivers and the published test lights; relative to the RMS of the
/// reference (design 7).
struct ErrorReport {
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of rms_relative, bootstrap over receivers
    double p95_relative = 0, max_relative = 0;
    std::uint32_t receivers_checked = 0;
    std::string reference;  ///< what it was measured against, in words
    struct ByEffect {
        std::string effect;
        double rms_relative = 0;
    };
    std::vector<ByEffect> by_effect;
};

struct BakeResult {
    formats::Asset asset;
    Knobs knobs;
    unsigned threads = 1;  ///< as used
    std::vector<PlanEntry> plan;
    std::vector<StageReport> stages;
    ErrorReport error;
    std::vector<formats::Diagnostic> warnings;
    double seconds_total = 0;
};

/// The whole bake: the stages in order, nothing else. Errors: usage (impossible options), resource,
/// interrupted (the context was cancelled).
formats::Result<BakeResult> run_bake(const formats::Scene& scene, const BakeOptions& options,
                                     const Context& context);

}  // namespace opaline::bake
