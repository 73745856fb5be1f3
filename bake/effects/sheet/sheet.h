#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that thin-walled surfaces reflect and transmit diffusely: leaves, paper, cloth.
EffectDescriptor describe_sheet(Effect id);

}  // namespace opaline::bake
