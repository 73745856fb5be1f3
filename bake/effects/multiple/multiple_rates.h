#pragma once

#include "bake/calibration/bench/calibration_bench.h"

namespace opaline::bake {

/// Measures the rates of this effect: samples of the surface, their sums over clusters, the gather,
/// and the surface integral of its truth.
void calibrate_multiple(const CalibrationBench& bench, Rates& rates);

}  // namespace opaline::bake
