#pragma once

#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/web/data_script.h"

namespace opaline::runtime {

/// A cloud layer in a page: at time 0. What turning the light about +Y changes of a `LayerLight` is
/// the direction of its suns, which is for scripts, and the light between ground and base, which is
/// solved here for some turns: between two of them the page interpolates.

/// Of one turn of the light, by cell.
struct LayerTurn {
    std::vector<formats::Rgb> ground, base;  ///< LayerLight::ground_light, base_light
};

/// A light above the first layer of an asset.
struct LightAboveLayer {
    LayerLight layer;             ///< the light as it stands
    std::vector<LayerTurn> turn;  ///< at equal steps of a whole turn; one: it is as the layer's
    formats::Environment below;  ///< where the page does not turn the light: what lights bodies, at
                                 ///< the centre of all (environment_at.h)
    bool turns = false;          ///< turns_layer
};

/// Whether the page of an asset with a layer turns the light: not where bodies mirror it, because
/// what they mirror is blurred as the page is written.
bool turns_layer(const formats::AssetView& asset);

/// Largest error of light between ground and base halfway between two turns, of its brightest cell;
/// more turns than kMostTurns, or than kMostTurnBytes hold, are not stored.
inline constexpr float kTurnTolerance = 0.03f;
inline constexpr std::size_t kMostTurns = 64, kMostTurnBytes = std::size_t{6} << 20;

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
