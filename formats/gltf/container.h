#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// A whole file in memory, or an error in `report` that names `where`.
std::optional<std::vector<std::byte>> read_whole_file(const std::filesystem::path& path,
                                                      const std::string& where, Report& report);

/// The two parts of a glTF file; both point into the bytes it was split from.
struct Container {
    std::string_view json;
    std::optional<std::span<const std::byte>> bin;  ///< second chunk of a binary file
};

/// Splits text or binary glTF, told apart by the magic number. Every length is checked against
/// the file's size (glTF 2.0 specification, "GLB File Format Specification").
std::optional<Container> split_container(std::span<const std::byte> bytes, Report& report);

}  // namespace opaline::formats::gltf
