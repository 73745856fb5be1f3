#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// What the rows of all effects share: what stands before the light, and how many bands it has.
EffectDescriptor describe_incident(Effect id);

}  // namespace opaline::bake
