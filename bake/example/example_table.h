#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "bake/example/example_scenes.h"
#include "bake/example/write_gltf.h"
#include "formats/image/png.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

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
