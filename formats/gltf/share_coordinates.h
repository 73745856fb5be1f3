#pragma once

#include "formats/gltf/document.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Whether a texture has the coordinates of those that the material has already; if it has none
/// yet, it takes this one's.
bool share_coordinates(const MaterialSource& source, const TextureUse& use, Material& material);

}  // namespace opaline::formats::gltf
