#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// Undoes EXT_meshopt_compression: each compressed buffer view gets its decoded bytes as a new
/// buffer, so that every later stage sees plain glTF. Precondition: check_member_types passed and
/// load_buffers ran.
void decode_meshopt_views(nlohmann::json& root, Resources& resources, Report& report);

}  // namespace opaline::formats::gltf
