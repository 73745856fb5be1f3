#pragma once

#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Work of rows with that many views of a receiver, and of truths with that many.
Work straight_rows_work(const SubjectCost& cost, double views);
Work straight_truth_work(const SubjectCost& cost, double views);

}  // namespace opaline::bake
