#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that scatters once inside a medium.
EffectDescriptor describe_single(Effect id);

}  // namespace opaline::bake
