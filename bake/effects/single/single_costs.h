#pragma once

#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Work of the steps of this effect (single.cpp).
Work light_maps_work(const SubjectCost& cost);
Work single_rows_work(const SubjectCost& cost);
Work single_truth_work(const SubjectCost& cost, double depth_samples);

}  // namespace opaline::bake
