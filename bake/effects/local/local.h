#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Media so dense that light leaves where it entered: one row stands for all effects inside.
EffectDescriptor describe_local(Effect id);

}  // namespace opaline::bake
