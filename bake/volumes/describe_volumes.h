#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light scattered once in volumes such as smoke or clouds. Volumes are no materials: the effect
/// has no rules of theirs and fills no rows of vertices (plan_volumes.h, bake_volumes.h).
EffectDescriptor describe_scattered_once(Effect id);

/// Light scattered more than once in volumes.
EffectDescriptor describe_scattered_often(Effect id);

/// Light that volumes scatter to surfaces: part of the rows of vertices (sent_light.h).
EffectDescriptor describe_sent_light(Effect id);

/// Light that surfaces send to volumes: part of the rows of nodes (exchange/seen_light.h).
EffectDescriptor describe_seen_light(Effect id);

}  // namespace opaline::bake
