#pragma once

#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/load_texture.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// The material with its KHR_materials_pbrSpecularGlossiness, where it has one, in the words of
/// pbrMetallicRoughness, KHR_materials_ior and KHR_materials_specular. Without a
/// specularGlossinessTexture nothing is lost: of an infinite index of refraction, F0 is the
/// specular colour (the conversion that KHR_materials_specular states).
MaterialSource as_metallic_roughness(MaterialSource source);

/// Takes the specularGlossinessTexture into a material that as_metallic_roughness made, texel by
/// texel together with the diffuse texture, by the conversion that Khronos publishes beside
/// KHR_materials_pbrSpecularGlossiness: a texture of specular colours has no place in
/// KHR_materials_specular's reading here, but metals have. True if that replaced base colour and
/// gloss, the diffuse texture's part included; else the texture's mean is in the gloss.
bool add_specular_glossiness(const SpecularGlossiness& source, const std::string& where,
                             TextureLoader& loader, Scene& scene, Material& material,
                             std::vector<std::string>& remarks);

}  // namespace opaline::formats::gltf
