#include "bake/accuracy/sweep/trace_truths.h"

#include <algorithm>
#include <utility>

#include "bake/accuracy/sweep/time_limit.h"
#include "bake/base/stage_log.h"

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

}  // namespace

formats::Result<SweepTruths> trace_truths(const formats::Scene& scene, const ModelProbes& probes,
                                          const TraceForOptions& options, double left,
                                          const Context& context) {
    const Clock::time_point start = Clock::now();
    SweepTruths truths;
    const double half = std::max(0.0, 0.5 * left);
    auto reference = trace_at_most(half, context, [&](const Context& limited) {
        return climb_reference(
            scene, {.seconds = options.seconds, .most_seconds = half, .seed = options.seed},
            limited);
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
    auto traced = trace_at_most(
        0.5 * (left - seconds_since(start)), context,
        [&](const Context& limited) { return trace_for(scene, probes, options, limited); });
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
