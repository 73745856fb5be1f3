#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// Undoes KHR_draco_mesh_compression: the primitive gets new accessors, views and a buffer with
/// the decoded indices and attributes, so that every later stage sees plain glTF. Vertices are in
/// the decoder's order, which the compressed data fixes. Precondition: check_member_types passed
/// and load_buffers ran.
void decode_draco_primitives(nlohmann::json& root, Resources& resources, Report& report);

}  // namespace opaline::formats::gltf
