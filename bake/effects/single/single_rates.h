#pragma once

#include "bake/calibration/bench/calibration_bench.h"

namespace opaline::bake {

/// Measures the rates of this effect: light maps (rendering alone, look-ups of nodes, further phase
/// terms), packed rows, and the quadrature of its truth.
void calibrate_single(const CalibrationBench& bench, Rates& rates);

}  // namespace opaline::bake
