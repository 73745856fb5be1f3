#pragma once

#include <span>

#include "bake/truth/test_lights.h"
#include "bake/calibration/calibration_bench.h"

namespace opaline::bake {

/// What media cost on a ball of few or of many triangles, into the rates of that size; those that
/// do not depend on it are measured on the one of many.

/// Light that enters through surface samples, and sums of it.
void calibrate_multiple(const CalibrationBench& bench, bool is_many, Rates& rates);
/// Light maps: with and without nodes to look up, and with more terms.
void calibrate_single(const CalibrationBench& bench, bool is_many, Rates& rates);
/// The self-check's truth under `lights`.
void calibrate_check(const CalibrationBench& bench, bool is_many, std::span<const TestLight> lights,
                     Rates& rates);

}  // namespace opaline::bake
