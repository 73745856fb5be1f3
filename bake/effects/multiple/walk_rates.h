#pragma once

#include <span>

#include "bake/calibration/bench/calibration_bench.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Measures the rates of random walks: an event in the bench's body, the sample at an exit, and the
/// weights of sites.
void calibrate_walks(const CalibrationBench& bench, std::span<const SurfaceSample> samples,
                     Rates& rates);

}  // namespace opaline::bake
