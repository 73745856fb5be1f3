#pragma once

#include "bake/plan/effect.h"

namespace opaline::bake {

/// The effects there are. A new one is a folder, a line here and a line in effects.cpp.
enum class Effect : std::uint8_t {
    direct,           ///< light reflected by opaque surfaces
    sheet,            ///< light reflected and transmitted by thin-walled surfaces
    multiple,         ///< light scattered many times inside media
    single,           ///< light scattered once inside media
    transmission,     ///< light that crosses media unscattered
    local,            ///< scattered light in media so dense that light leaves where it entered
    specular,         ///< light mirrored at the boundary of media
    gloss,            ///< light mirrored by opaque surfaces
    interreflection,  ///< light that goes from surface to surface
    volume_single,    ///< light scattered once in volumes
    volume_multiple,  ///< light scattered more than once in volumes
    volume_surface,   ///< light that volumes scatter to surfaces
    surface_volume,   ///< light that surfaces send to volumes
    cloud,            ///< light scattered by cloud layers
    radiosity,        ///< light between cloud layers and the ground
    emitters,         ///< light of lamps in the scene
    incident          ///< what all share: what stands before the light, and its colour
};

const EffectTable& all_effects();

}  // namespace opaline::bake
