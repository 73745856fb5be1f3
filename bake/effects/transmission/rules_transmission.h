#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Share of even light that crosses a ball of the medium straight, as its surface shows it on
/// average over views: the mean of e^(-depth c') under F_t(c) c, c' the cosine c refracted.
/// `depth` >= 0: optical, along the diameter. It is an upper bound for every point of a body at
/// which a ball of that diameter touches the surface from inside (README.md, "Bounds").
double straight_share(double eta, double depth);

/// The share that a typical point of a body shows, in its clearest band: 1 where its thickness is
/// not known.
double typical_share(const formats::Medium& medium, const MaterialFacts& body);

/// The same of thin parts: the bound of the rule.
double thin_share(const formats::Medium& medium, const MaterialFacts& body);

/// The rules `transmission` and, after it, `transmission.view`.
PlanEntry decide_transmission(const PlanInput& input);
PlanEntry decide_straight_views(const PlanInput& input);

}  // namespace opaline::bake
