#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/container.h"
#include "formats/gltf/report.h"
#include "formats/gltf/sha256.h"

namespace opaline::formats::gltf {

using Bytes = std::span<const std::byte>;

/// All files of an asset. Each is read and hashed once, in reading order, and its bytes stay in
/// place until the import ends. No other code reads files.
struct Resources {
    std::filesystem::path folder;                  ///< of the asset
    std::vector<std::filesystem::path> allowed;    ///< no file outside of these and it is opened
    std::deque<std::vector<std::byte>> storage;    ///< owns what `buffers` and callers point into
    std::vector<Bytes> buffers;                    ///< by glTF buffer index
    std::map<std::filesystem::path, Bytes> files;  ///< external files by their real path
    std::vector<std::filesystem::path> inputs;     ///< as for Scene::inputs
    std::uint64_t bytes_held = 0;
    Sha256 hash;

    Bytes keep(std::vector<std::byte> bytes);
};

/// The bytes of a file named relative to the asset's folder, or absolutely. The file itself, after
/// symbolic links and "..", must lie in that folder or in an allowed one.
std::optional<Bytes> read_inside(Resources& resources, std::string_view name,
                                 const std::string& where, Report& report);

/// The bytes that a `uri` of the asset stands for: base64 data URI, or a percent-encoded
/// name for read_inside.
std::optional<Bytes> read_uri(Resources& resources, std::string_view uri, const std::string& where,
                              Report& report);

/// Fills `resources.buffers`. A buffer without a `uri` is the binary chunk if it is the first, or
/// an empty placeholder if EXT_meshopt_compression marks it as one.
void load_buffers(const nlohmann::json& root, const Container& container, Resources& resources,
                  Report& report);

}  // namespace opaline::formats::gltf
