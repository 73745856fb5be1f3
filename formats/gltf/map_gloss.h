#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// The gloss of an opaque material, without its image: `pbrMetallicRoughness`,
/// `KHR_materials_specular` and `KHR_materials_ior`, clamped to their ranges. `remarks` gets one
/// sentence for each property that differs from the file.
Gloss map_gloss(const TranslucencySource& source, std::vector<std::string>& remarks);

/// Multiplies the factors by the image's means, for an image that cannot be looked up point by
/// point.
void apply_mean(const Image8& metallic_roughness, Gloss& gloss);

}  // namespace opaline::formats::gltf
