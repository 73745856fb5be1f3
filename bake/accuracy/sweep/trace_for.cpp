#include "bake/accuracy/sweep/trace_for.h"

#include <algorithm>
#include <chrono>

#include "bake/base/stage_log.h"

namespace opaline::bake {

formats::Result<std::vector<LightCheck>> trace_for(const formats::Scene& scene,
                                                   const ModelProbes& probes,
                                                   const TraceForOptions& options,
                                                   const Context& context) {
    constexpr std::uint64_t kFewEvents = 300000;  // for each light
    constexpr double kMostTimes = 1000;
    ModelCheckOptions wanted;
    wanted.seed = options.seed;
    wanted.simulated = options.simulated;
    wanted.lit_by_volumes = options.lit_by_volumes;
    wanted.volumes_see_surfaces = options.volumes_see_surfaces;
    wanted.max_events = kFewEvents;
    const Clock::time_point start = Clock::now();
    auto traced = trace_model_truth(scene, probes, wanted, context);
    const std::chrono::duration<double> took = Clock::now() - start;
    const double times = std::min(options.seconds / std::max(took.count(), 1e-3), kMostTimes);
    if (!traced || times < 2) {
        return traced;
    }
    wanted.max_events = static_cast<std::uint64_t>(times * static_cast<double>(kFewEvents));
    return trace_model_truth(scene, probes, wanted, context);
}

}  // namespace opaline::bake
