#pragma once

#include <span>

#include "bake/calibration/calibration_bench.h"
#include "bake/truth/test_lights.h"

namespace opaline::bake {

/// Measures the rates of media on a ball of few or of many triangles. Rates that do not depend on
/// the size are measured on the large one.

/// Irradiance transport of surface samples, and its sums over clusters.
void calibrate_multiple(const CalibrationBench& bench, bool is_many, Rates& rates);
/// Light maps: rendering alone, look-ups of nodes, and further phase terms.
void calibrate_single(const CalibrationBench& bench, bool is_many, Rates& rates);
/// The self-check's truth under `lights`.
void calibrate_check(const CalibrationBench& bench, bool is_many, std::span<const TestLight> lights,
                     Rates& rates);

}  // namespace opaline::bake
