#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/walk_scene.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Fills `scene.lights`: one for each of these nodes, which carry a light. Needs `scene.origin`.
/// A light's name is its node's, else its own, else "light"; one that is taken gets the first free
/// number from 2 on behind it ("Lamp 2"). Values out of their ranges are clamped with a warning.
void build_lights(const Document& document, const std::vector<NodeInstance>& nodes,
                  double metres_per_unit, Scene& scene, Report& report);

}  // namespace opaline::formats::gltf
