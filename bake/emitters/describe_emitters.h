#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light of lamps in the scene. Emitters are no materials: the effect has no rules for them, and
/// its rows are stored beside those of the environment (plan_emitters.h, bake_emitters.h).
EffectDescriptor describe_emitters(Effect id);

}  // namespace opaline::bake
