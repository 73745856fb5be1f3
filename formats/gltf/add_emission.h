#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Material::emission: `emissiveFactor`, clamped to [0, 1], times the strength, clamped to
/// [0, 1e12] [nit], and the texture. Comes after the material's other textures, which decide on its
/// coordinates: of a texture that is mapped otherwise, the mean counts. `remarks` gets one sentence
/// for each property that differs from the file; `where` names the material.
void add_emission(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                  Material& material, std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
