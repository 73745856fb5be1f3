#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/read_primitive.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/gltf/walk_scene.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// Scene::origin [m] for these instances. On each axis it is the middle of the scene's bounds,
/// rounded to a multiple of a power of two between one and two radii of the scene. It is 0 where
/// the middle is within 16 radii of 0, which costs at most four bits of float precision: scenes
/// modelled near the origin keep their coordinates. A scene moved far away by its root node gets
/// the coordinates that it has at the origin. Precondition: validate_document found no fault.
glm::dvec3 choose_origin(const Document& document, const std::vector<MeshInstance>& instances,
                         const std::vector<Bytes>& buffers, double metres_per_unit);

/// Warns if the float spacing exceeds 1 % of the primitive's mean edge length: in the coordinates
/// that the file stores, in the scene's frame (`placed`), or in world space, where baked files keep
/// positions.
void warn_of_coarse_positions(const PrimitiveData& stored, const Primitive& placed,
                              glm::dvec3 origin, Report& report);

}  // namespace opaline::formats::gltf
