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

/// Scene::origin [m] for these instances: along each axis the middle of the scene's bounds, rounded
/// to a multiple of a power of two about as large as the scene; 0 where the middle is no farther
/// from 0 than 16 radii of the scene, which costs floats four bits at most. So a scene that is
/// modelled about the origin keeps its coordinates, and one that is moved far away gets those back.
/// Precondition: validate_document found no fault.
glm::dvec3 choose_origin(const Document& document, const std::vector<MeshInstance>& instances,
                         const std::vector<Bytes>& buffers, double metres_per_unit);

/// Warns where floats are too coarse for a primitive's edges: those that the file stores, those of
/// the scene's frame (`placed`), or those in world space, which a baked file holds.
void warn_of_coarse_positions(const PrimitiveData& stored, const Primitive& placed,
                              glm::dvec3 origin, Report& report);

}  // namespace opaline::formats::gltf
