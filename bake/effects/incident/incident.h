#pragma once

#include "bake/plan/effect.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {

/// Decides whether a medium or thin-walled surface needs three bands. With one band, the difference
/// between the bands is lost. Bands differ by their coefficients only, because base colour, texture
/// and veins multiply the light that leaves and are in no row. So nothing is lost where the
/// coefficients are equal. Otherwise two non-negative bands differ at most by the larger, which the
/// medium's simulated effects bound.
PlanEntry decide_colour(const PlanInput& input);

/// What the rows of all effects share: what stands before the light, and how many bands it has.
EffectDescriptor describe_incident(Effect id);

}  // namespace opaline::bake
