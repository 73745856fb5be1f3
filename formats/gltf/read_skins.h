#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// `skins` of the document. Precondition: check_member_types passed.
std::vector<Skin> read_skins(const nlohmann::json& root, Report& report);

}  // namespace opaline::formats::gltf
