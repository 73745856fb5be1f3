#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// KHR_materials_pbrSpecularGlossiness of every material that has it.
std::vector<std::optional<SpecularGlossiness>> read_specular_glossiness(const nlohmann::json& root,
                                                                        Report& report);

}  // namespace opaline::formats::gltf
