#include "bake/lab/sweep/trace_truths.h"

#include <algorithm>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/lab/sweep/run_sweep.h"

namespace opaline::bake {
namespace {

// `trace` with a context that stops it.
template <class Trace>
auto trace_at_most(double seconds, const Context& context, Trace&& trace) {
    const TimeLimit limit(seconds, context.cancel);
    Context limited = context;
    limited.cancel = limit.flag();
    return trace(limited);
}

// Path tracing that the total error of every bake is measured against: few at first, and more as
// long as the time allows; the least amount is traced whatever it takes. Once cancelled, what was
// traced by then. Errors: as trace_model_truth, if that is nothing.
formats::Result<std::vector<LightCheck>> trace_for(const formats::Scene& scene,
                                                   const ModelProbes& probes,
                                                   ModelCheckOptions wanted, double seconds,
                                                   const Context& context) {
    constexpr std::uint64_t kFewEvents = 20000, kMostEvents = 300000000;  // for each light
    constexpr double kMostTimes = 16;  // the time of few events predicts that of many badly
    wanted.max_events = kFewEvents;
    std::vector<LightCheck> fewer;  // of the round before
    for (double left = seconds;;) {
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

}  // namespace

formats::Result<SweepTruths> trace_truths(const formats::Scene& scene, const ModelProbes& probes,
                                          const ModelCheckOptions& options, double seconds,
                                          double left, const Context& context) {
    const Clock::time_point start = Clock::now();
    SweepTruths truths;
    const double half = std::max(0.0, 0.5 * left);
    auto reference = trace_at_most(half, context, [&](const Context& limited) {
        return climb_reference(
            scene, {.seconds = seconds, .most_seconds = half, .seed = options.seed}, limited);
    });
    if (reference) {
        truths.reference = std::move(*reference);
    } else if (reference.error().kind != formats::ErrorKind::interrupted) {
        return std::move(reference).error();
    }
    if (!truths.reference) {
        truths.left_out.push_back({"ladder of the Monte Carlo reference",
                                   "no light reaches the receivers, or its first rungs would take "
                                   "more than half of the time that was left"});
    }
    auto traced =
        trace_at_most(0.5 * (left - seconds_since(start)), context, [&](const Context& limited) {
            return trace_for(scene, probes, options, seconds, limited);
        });
    if (traced) {
        truths.traced = std::move(*traced);
    } else if (traced.error().kind != formats::ErrorKind::interrupted) {
        return std::move(traced).error();
    } else {
        truths.left_out.push_back({"total error",
                                   "the path tracing that it is measured against was not done in "
                                   "half of the time that was left"});
    }
    return truths;
}

}  // namespace opaline::bake
