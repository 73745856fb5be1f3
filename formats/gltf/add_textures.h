#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// The textures of a material whose factors are mapped, and its emission: `emissiveFactor`, clamped
/// to [0, 1], times the strength, clamped to [0, 1e12] [nit]. A primitive has one set of
/// coordinates for all of them, the first texture's in the order base colour, metallic-roughness,
/// scattering, emission, normals; of one that is mapped otherwise the mean counts, or nothing.
/// `remarks` gets one sentence for each property that differs from the file; `where` names the
/// material.
void add_textures(const MaterialSource& source, const std::string& where, TextureLoader& loader,
                  Material& material, std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
