#pragma once

#include <utility>

#include "bake/lab/sweep/run_sweep.h"
#include "tests/support/effects.h"

namespace opaline::tests {

/// A sweep that had time for `points` points at least. Starts with options.seconds and doubles
/// them up to a hundredfold, as how many points fit (none is an error) depends on the machine and
/// on what else runs.
inline formats::Result<bake::SweepResult> sweep_with_enough_time(const formats::Scene& scene,
                                                                 bake::SweepOptions options,
                                                                 std::size_t points) {
    const double most = 100 * options.seconds;
    auto result = bake::run_sweep(bake::all_effects(), scene, options, {}, {});
    while ((!result || result->points.size() < points) && options.seconds < most) {
        options.seconds *= 2;
        result = bake::run_sweep(bake::all_effects(), scene, options, {}, {});
    }
    return result;
}

}  // namespace opaline::tests
