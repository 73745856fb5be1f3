#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// One entry for each material of a file that passed check_member_types. Errors: members of a wrong
/// type. Values out of the extensions' ranges are kept: map_medium judges them.
std::vector<TranslucencySource> read_translucency(const nlohmann::json& root, Report& report);

}  // namespace opaline::formats::gltf
