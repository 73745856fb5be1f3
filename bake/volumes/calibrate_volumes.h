#pragma once

#include "bake/calibration/bench/calibration_bench.h"

namespace opaline::bake {

/// The volume on which rates are measured: a ball of even density 1, 48 voxels of 1 m across and 12
/// mean free paths deep, that absorbs a hundredth.
formats::Scene make_calibration_volume();

/// Measures the seconds of a step of an optical depth, of a flight, and of light that joins a walk,
/// by bakes of that ball. They do not depend on the triangles of the bench.
void calibrate_volumes(const CalibrationBench& bench, Rates& rates);

}  // namespace opaline::bake
