#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// KHR_texture_transform: translation * rotation * scale. Its example (offset 0 1, rotation pi/2,
/// scale 1/2 is the lower left quadrant) holds for a rotation that is counter-clockwise with v
/// pointing down, so sin enters with the opposite sign of a v-up plane.
glm::mat3 texture_transform(glm::dvec2 offset, double rotation, glm::dvec2 scale);

/// A textureInfo object of an extension, which tinygltf leaves to us; its links are not checked.
/// Faults go to `report`, named by `where`, and give no texture.
TextureUse read_texture_use(const nlohmann::json& info, const std::string& where, Report& report);

}  // namespace opaline::formats::gltf
