#pragma once

#include "formats/opal/asset.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/web/data_script.h"

namespace opaline::runtime {

/// A cloud layer in a page. Scripts and shaders there blend its frames, move it with the wind, turn
/// its suns about +Y and solve the light between ground and base (page_layer.h): they need the
/// layer, and each light above it as it stands.

/// Arrays of the layer, and where it lights bodies (clouds/part_environments.h).
void put_layer(DataScript& script, const formats::AssetView& asset);
/// Arrays of a light above it, at time 0.
void put_layer_light(DataScript& script, const LayerLight& light);

}  // namespace opaline::runtime
