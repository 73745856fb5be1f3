#pragma once

#include "bake/calibration/bench/calibration_bench.h"
#include "bake/plan/rates.h"

namespace opaline::bake {

/// Seconds of the units of work of layers (layer_work.h): 0.1 s in all.
void calibrate_layers(const CalibrationBench& bench, Rates& rates);

}  // namespace opaline::bake
