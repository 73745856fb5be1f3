#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/check/model_truth.h"
#include "bake/lab/sweep/reference_ladder.h"

namespace opaline::bake {

/// What surfaces' and volumes' bakes are compared with, as far as there was time for it.
struct SweepTruths {
    std::optional<ReferenceLadder> reference;
    std::vector<LightCheck> traced;  ///< that total errors are against
    struct LeftOut {
        std::string name, reason;
    };
    std::vector<LeftOut> left_out;
};

/// `options`: of the path tracing, but for its amount. Each of both takes about `seconds`, and is
/// stopped after half of the `left` seconds that are left by then. A truth that the context stops
/// is left out as well. Errors: resource.
formats::Result<SweepTruths> trace_truths(const formats::Scene& scene, const ModelProbes& probes,
                                          const ModelCheckOptions& options, double seconds,
                                          double left, const Context& context);

}  // namespace opaline::bake
