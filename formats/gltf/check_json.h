#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// Bounds on depth and number of values, in one pass over the characters: JSON that passes can be
/// given to a recursive parser. Errors in `report` otherwise.
bool within_json_bounds(std::string_view text, Report& report);

/// The gate in front of every JSON reader: bounds on depth and number of values, well-formed text,
/// glTF version 2, and no required extension that Opaline would not honour.
/// Returns the parsed text, or nothing and errors in `report`.
std::optional<nlohmann::json> parse_checked_json(std::string_view text, Report& report);

/// Types of the members that later stages rely on: top-level arrays of objects, whole non-negative
/// numbers for every index, count and offset, number arrays of the right length in nodes. (The
/// parser behind it silently treats a wrong type as an absent member.)
void check_member_types(const nlohmann::json& root, Report& report);

}  // namespace opaline::formats::gltf
