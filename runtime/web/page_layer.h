#pragma once

#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/web/data_script.h"

namespace opaline::runtime {

/// A cloud layer in a page. Scripts and shaders there blend its frames, move it with the wind, turn
/// its suns about +Y and solve the light between ground and base (page_radiosity.h): they need the
/// layer, and each light above it as it stands.

/// A light above the first layer of an asset, at time 0.
struct LightAboveLayer {
    LayerLight layer;
    formats::Environment below;  ///< where nothing moves in the page: what lights bodies, at the
                                 ///< centre of all (environment_at.h)
    bool moves = false;          ///< moves_layer
};

/// Whether the page of an asset with a layer turns the light and moves the clouds: not where bodies
/// mirror light, because what they mirror is blurred as the page is written.
bool moves_layer(const formats::AssetView& asset);

/// Precondition: the asset has a layer. `threads` 0: all cores; the same bits for any number.
LightAboveLayer light_above_layer(const formats::AssetView& asset,
                                  const formats::Environment& environment, unsigned threads);

/// Arrays of the layer alone.
void put_layer(DataScript& script, const formats::AssetView& asset);
/// Arrays of a light above it.
void put_layer_light(DataScript& script, const LightAboveLayer& above);

/// Whether its bodies stand so far apart that pictures light them at points of their own.
bool has_bodies_apart(const formats::AssetView& asset);

}  // namespace opaline::runtime
