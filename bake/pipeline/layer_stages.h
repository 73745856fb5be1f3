#pragma once

#include <span>

#include "bake/effects/layers/bake_layers.h"
#include "bake/pipeline/pipeline.h"

namespace opaline::bake {

/// Adds the cloud layers of a file to `result` and measures their tables' error: as `layer_error`,
/// as that of the effect "cloud" in `error`, and in a file without receivers as all of `error`.
/// Warns where the error is above the target or what passes unnoticed, and where droplets are so
/// alike that single spheres' ripples show. Errors: as bake_layers; interrupted.
formats::Status add_layers(const formats::Scene& scene, std::span<const LayerLayout> layouts,
                           const Context& context, BakeResult& result);

}  // namespace opaline::bake
