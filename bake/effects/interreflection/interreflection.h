#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that one surface reflects, or that leaves a body, to another surface, any number of times.
EffectDescriptor describe_interreflection(Effect id);

}  // namespace opaline::bake
