#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that scatters many times inside a medium: the dipole gathered over surface samples.
EffectDescriptor describe_multiple(Effect id);

}  // namespace opaline::bake
