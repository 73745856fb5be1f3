#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that opaque surfaces mirror, by glTF's metallic-roughness BRDF: openness, and the record
/// that the runtime's shading reads (formats/opal/gloss_model.h).
EffectDescriptor describe_gloss(Effect id);

}  // namespace opaline::bake
