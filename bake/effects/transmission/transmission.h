#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that crosses media straight, without being scattered: what a clear body shows.
EffectDescriptor describe_transmission(Effect id);

}  // namespace opaline::bake
