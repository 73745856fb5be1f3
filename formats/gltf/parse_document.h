#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// Turns JSON that passed parse_checked_json and check_member_types, with compression already
/// undone, into a Document, by way of tinygltf. tinygltf sees neither buffers nor images and opens
/// no file. Links are not yet known to be valid: see validate_document.
std::optional<Document> parse_document(nlohmann::json root, Report& report);

}  // namespace opaline::formats::gltf
