#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light scattered by cloud layers. Layers are no materials: the effect has no rules of theirs and
/// fills no rows of vertices (plan_layers.h, bake_layers.h).
EffectDescriptor describe_cloud(Effect id);

/// Light that goes back and forth between a layer and the ground below it.
EffectDescriptor describe_radiosity(Effect id);

}  // namespace opaline::bake
