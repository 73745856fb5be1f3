#include "bake/accuracy/sweep/trace_for.h"

#include <algorithm>
#include <chrono>

#include "bake/base/stage_log.h"

namespace opaline::bake {

formats::Result<std::vector<LightCheck>> trace_for(const formats::Scene& scene,
                                                   const ModelProbes& probes,
                                                   const TraceForOptions& options,
                                                   const Context& context) {
    constexpr std::uint64_t kFewEvents = 20000, kMostEvents = 300000000;  // for each light
    constexpr double kMostTimes = 16;  // the time of few events predicts that of many badly
    ModelCheckOptions wanted;
    wanted.seed = options.seed;
    wanted.simulated = options.simulated;
    wanted.lit_by_volumes = options.lit_by_volumes;
    wanted.volumes_see_surfaces = options.volumes_see_surfaces;
    wanted.max_events = kFewEvents;
    std::vector<LightCheck> fewer;  // of the round before
    for (double left = options.seconds;;) {
        const Clock::time_point start = Clock::now();
        auto traced = trace_model_truth(scene, probes, wanted, context);
        if (!traced && traced.error().kind == formats::ErrorKind::interrupted && !fewer.empty()) {
            return fewer;
        }
        const double took = std::max(seconds_since(start), 1e-3);
        left -= took;
        const double times = std::min(left / took, kMostTimes);
        if (!traced || times < 2 || wanted.max_events >= kMostEvents) return traced;
        fewer = std::move(*traced);
        wanted.max_events =
            std::min(kMostEvents,
                     static_cast<std::uint64_t>(times * static_cast<double>(wanted.max_events)));
    }
}

}  // namespace opaline::bake
