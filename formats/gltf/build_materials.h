#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/gltf/walk_scene.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Fills `scene.materials`, one per material of the file in its order and a default one behind them
/// where a primitive needs it or there is none, and `scene.images` with the decoded base-colour,
/// metallic-roughness and emissive textures. The default is white and diffuse, where glTF's own is
/// a white rough metal: a file without a material says nothing about its surface. Textures are read
/// and warnings given only for materials that an instance uses. Every property that Opaline does
/// not simulate is named in one warning. Extensions that describe a scattering medium become
/// Material::medium (map_medium.h); materials without one get Material::gloss (map_gloss.h).
void build_materials(const Document& document, const std::vector<MeshInstance>& instances,
                     double metres_per_unit, Resources& resources, Scene& scene, Report& report);

}  // namespace opaline::formats::gltf
