#pragma once

#include "bake/calibration/bench/calibration_bench.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Work of rows with that many views of a receiver, and of truths with that many.
Work straight_rows_work(const SubjectCost& cost, double views);
Work straight_truth_work(const SubjectCost& cost, double views);

/// Rates::straight_view and straight_cell: on a ball of which most light crosses.
void calibrate_transmission(const CalibrationBench& bench, Rates& rates);

}  // namespace opaline::bake
