#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Relative RMS that one row for all views errs by, over the views: an estimate from the body's
/// mean chord in transport mean free paths and from the albedo (walks/README.md, "Views").
double one_view_error(const formats::Medium& medium, const MaterialFacts& body);

/// The rule `multiple.view`: 4 rows where random walks that hold light of all orders are expected
/// and one row for all views would err by more than 3 % (reference: 1 %, preview: 10 %, draft: 20
/// %), or more than half of Knobs::error_target; open bodies at draft and preview have one row.
/// After the rule `multiple.model`.
PlanEntry decide_views(const PlanInput& input);

}  // namespace opaline::bake
