#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "formats/media/media_file.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// Reads a media file (JSON): what fills the materials of a scene. Keys and units are listed in
/// README.md of this folder. Untrusted input is safe: depth and size are bounded, and what it
/// names is read from its folder and from `allowed_folders` only, wherever links lead.
///
/// Errors, all that are found: `bad_input` for a file that is missing, not JSON, or has an unknown
/// key, a wrong type, a value out of range or keys that contradict each other; `resource` past the
/// limits of formats/gltf/limits.h or past memory.
Result<MediaFile> read_media(const std::filesystem::path& path,
                             std::span<const std::filesystem::path> allowed_folders = {});

/// The same object from inside another file, as the glTF root extension OPALINE_media is. `file`
/// is named in messages and its folder holds the tables; `where` leads to the object. The result's
/// inputs are the tables alone.
Result<MediaFile> parse_media(std::string_view json, const std::filesystem::path& file,
                              const std::string& where,
                              std::span<const std::filesystem::path> allowed_folders = {});

}  // namespace opaline::formats
