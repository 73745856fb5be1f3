#pragma once

#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Decides whether light from other surfaces matters to a material's receivers. Under uniform light
/// of radiance 1 no surface is brighter than its albedo, so what others send to a receiver is at
/// most the share o of its hemisphere that they may cover (rules_visibility.h), times the largest
/// albedo of the scene, times its own:
///     bound = rho o rho_max.
PlanEntry decide_interreflection(const PlanInput& input);

}  // namespace opaline::bake
