#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Media so dense that light leaves where it entered: one row stands for all effects inside.
/// `rules`: what decides that.
EffectDescriptor describe_local(Effect id, std::span<const DecisionRule> rules);

}  // namespace opaline::bake
