#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/gltf/report.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// Reads the root's member "emitters": an object with a list of names for each group's name.
/// `where`: of the root. Faults go to the report: no name, a name without an end, one that stands
/// in two groups or twice in one. Absent: none.
std::vector<EmitterGroup> read_emitter_groups(const nlohmann::json& root, const std::string& where,
                                              gltf::Report& report);

}  // namespace opaline::formats::media
