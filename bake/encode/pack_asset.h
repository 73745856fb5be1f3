#pragma once

#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Puts a scene's preview geometry and its finished transport rows into one asset: one row
/// (one term) per vertex, primitives in scene order; grey, or RGB where the material has a medium.
/// `transport` has as many rows as the scene has vertices.
formats::Asset pack_asset(const formats::Scene& scene, formats::SparseRows transport);

}  // namespace opaline::bake
