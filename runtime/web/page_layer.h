#pragma once

#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/web/data_script.h"

namespace opaline::runtime {

/// A cloud layer in a page: lit as the files of lights are written, at time 0, so that a page with
/// one does not turn its light.

/// A light above the first layer of an asset, and what reaches the asset's bodies of it.
struct LightAboveLayer {
    LayerLight layer;
    formats::Environment below;  ///< at the centre of all bodies (environment_at.h)
};
/// Precondition: the asset has a layer. `threads` 0: all cores; the same bits for any number.
LightAboveLayer light_above_layer(const formats::AssetView& asset,
                                  const formats::Environment& environment, unsigned threads);

/// Arrays of the layer alone.
void put_layer(DataScript& script, const formats::AssetView& asset);
/// Arrays of a light above it.
void put_layer_light(DataScript& script, const LayerLight& light);

/// Whether its bodies stand so far apart that pictures light them at points of their own.
bool has_bodies_apart(const formats::AssetView& asset);

}  // namespace opaline::runtime
