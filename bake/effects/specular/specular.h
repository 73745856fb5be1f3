#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that the boundary of a medium mirrors: openness, which the runtime's shading reads.
EffectDescriptor describe_specular(Effect id);

}  // namespace opaline::bake
