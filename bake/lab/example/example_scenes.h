#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/lab/example/write_gltf.h"
#include "formats/image/png.h"
#include "formats/opal/result.h"
#include "formats/sparse_grid.h"

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

/// A volume, and what it is made of.
struct ExampleVolume {
    formats::SparseGrid<float> (*make)() = nullptr;
    std::array<double, 3> sigma_t{};  ///< [1/m] where the density is 1
    std::array<double, 3> albedo{};
    double g = 0;                                                ///< Henyey-Greenstein
    double rms_angle = 0;                                        ///< [rad]; > 0: Gaussian instead
    formats::SparseGrid<float> (*make_temperature)() = nullptr;  ///< [K]
    double emission_scale = 1;                                   ///< of a black body's radiance
};

/// A cloud layer: the picture of the ground, and the media file that names it.
struct ExampleLayer {
    formats::Image8 (*make_ground)() = nullptr;
    std::string (*describe)(const std::string& ground) = nullptr;
};

/// A scene that the program makes.
struct Example {
    ExampleInfo info;
    std::vector<GltfObject> (*make)() = nullptr;             ///< null: a volume or a layer alone
    ExampleVolume volume = {};                               ///< make null: there is none
    ExampleLayer layer = {};                                 ///< make_ground null: there is none
    std::vector<GltfPointLight> (*make_lights)() = nullptr;  ///< null: none
    const char* media = "";                                  ///< of materials, as a media file
    formats::Image8 (*make_image)() = nullptr;               ///< NAME.png, of an object; null: none
};

/// All of them, in the order of list_examples().
std::span<const Example> all_examples();

}  // namespace opaline::bake
