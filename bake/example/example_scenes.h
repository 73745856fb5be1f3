#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "bake/example/write_gltf.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// A scene that the program makes itself; nothing is downloaded.
struct ExampleInfo {
    std::string_view name;     ///< what the user types, and the stem of the files
    std::string_view summary;  ///< one line
};

/// All of them, the showpiece first.
std::span<const ExampleInfo> list_examples();

/// The objects of a scene, the figure first and its floor last: metres, +Y up, floor at y = 0,
/// front toward +Z; none of a volume or cloud layer alone. Takes a second or two; same result on
/// every run and any number of threads. Errors: usage, if there is no such scene; the message lists
/// those there are.
formats::Result<std::vector<GltfObject>> make_example(std::string_view name);

/// Writes a scene as FOLDER/NAME.gltf and FOLDER/NAME.bin, creating the folder if need be, and
/// returns the files written, the scene first. A volume goes into FOLDER/NAME.vdb, the ground below
/// a cloud layer into FOLDER/NAME.png, and what they are made of into the .gltf; where there is no
/// mesh, into FOLDER/NAME.json, which is the scene then.
/// Errors: usage, if there is no such scene; resource, if the files cannot be written.
formats::Result<std::vector<std::filesystem::path>> write_example(
    std::string_view name, const std::filesystem::path& folder);

}  // namespace opaline::bake
