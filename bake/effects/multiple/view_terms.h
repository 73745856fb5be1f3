#pragma once

#include "bake/effects/multiple/medium_profile.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Relative RMS error of one row for all views, over the views: an estimate from the body's mean
/// chord in transport mean free paths and from the albedo (walks/README.md, "Views").
double one_view_error(const formats::Medium& medium, const MaterialFacts& body);

/// The same for four rows, linear in the view: the part of degree two of the radiance of a plate or
/// a ball with the same mean chord. Bodies that are no plates take the smaller of both, because
/// their round parts are unknown. Open bodies have no known thickness and count as plates of one
/// mean free path.
double four_views_error(const formats::Medium& medium, const MaterialFacts& body);

/// The rule `multiple.view`: rows where random walks that hold light of all orders are expected, 4
/// where one row for all views would err by more than .5 % (preview: 5 %, draft: 20 %) or three
/// tenths of Knobs::error_target, and 9 where four would by more than 3 % (reference: 1 %, preview:
/// 10 %, draft: 20 %) or as much of the target; open bodies at draft have one row.
/// After the rule `multiple.model`.
PlanEntry decide_views(const PlanInput& input);

/// Whether the error of rows for all views is measured before the bake: from preview on, where the
/// user did not choose their number.
bool measures_views(const Knobs& knobs);

/// The decision once the errors are measured; the estimate counts where it is larger. Open bodies
/// get rows by view as well then.
void amend_views(const ModelError& measured, const PlanInput& input, PlanEntry& entry);

}  // namespace opaline::bake
