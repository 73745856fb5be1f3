#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/gltf/resources.h"
#include "formats/media/media_file.h"

namespace opaline::formats::media {

/// One entry of `materials`; every fault is in `report`, and the result counts only if there is
/// none. sigma_s_prime, given or from a preset, becomes sigma_s = sigma_s' / (1 - g) with g the
/// mean cosine of `phase`. Tables and images are read through `resources`.
MaterialMedium read_material(const std::string& name, const nlohmann::json& entry,
                             const std::string& where, gltf::Resources& resources,
                             gltf::Report& report);

}  // namespace opaline::formats::media
