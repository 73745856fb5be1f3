#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// The extension of nodes that draw their mesh at several places.
inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// EXT_mesh_gpu_instancing of a node; empty where it does not have it.
Attributes read_instances(const NamedObject& node);

/// Number of places of a node's mesh: as many as its attributes have values, or one.
std::uint64_t instance_count(const Document& document, const Node& node);

/// Those places, in the node's frame: TRANSLATION, ROTATION and SCALE as of a node, each of them
/// floats or normalised integers; the identity where one is missing. Empty, with errors named after
/// `where`, if they do not conform. Precondition: validate_document found no fault.
std::vector<glm::dmat4> instance_transforms(const Document& document,
                                            const std::vector<Bytes>& buffers, const Node& node,
                                            const std::string& where, Report& report);

}  // namespace opaline::formats::gltf
