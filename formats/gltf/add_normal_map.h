#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Material::normal_image with its scale: `normalTexture`. Comes after the material's other
/// textures, which decide on its coordinates: one that is mapped otherwise is left out. `remarks`
/// gets one sentence for each property that differs from the file; `where` names the material.
void add_normal_map(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                    Material& material, std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
