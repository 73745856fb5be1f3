#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// The lights of KHR_lights_punctual in a file that passed check_member_types, with the extension's
/// defaults. Errors: members of a wrong type, an unknown type of light. Values out of their ranges
/// are kept: build_lights judges them.
std::vector<LightSource> read_lights(const nlohmann::json& root, Report& report);

/// The light that a node carries, kNone where it has none. The link is not checked.
std::uint32_t read_node_light(const NamedObject& node);

}  // namespace opaline::formats::gltf
