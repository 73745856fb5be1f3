#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that opaque surfaces reflect diffusely; media too where they are compared with surfaces.
EffectDescriptor describe_direct(Effect id);

}  // namespace opaline::bake
