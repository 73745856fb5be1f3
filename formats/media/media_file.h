#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/media/height_fields.h"
#include "formats/scene.h"

namespace opaline::formats {

/// The entry of a media file for one material.
struct MaterialMedium {
    std::string name;               ///< of the glTF material; "*": all that no other entry names
    std::optional<Medium> medium;   ///< none: opaque, whatever the glTF file says
    std::optional<Sheet> sheet;     ///< thin-walled; no medium then
    std::optional<Rgb> base_color;  ///< replaces the material's factor; linear, each in [0, 1]
    std::optional<Image8> albedo;   ///< replaces the texture; multiplies the light that leaves
    std::optional<Marble> marble;   ///< multiplies the light that leaves, by position
    /// Images of the medium's variation, which then is there.
    std::optional<Image8> scatter, density;
};

/// A volume that a media file places.
struct VolumeEntry {
    std::string where;           ///< in the media file, for messages: "volumes > 0"
    std::string material;        ///< of the closed meshes whose inside it is; empty: a file says it
    std::uint32_t voxels = 64;   ///< of such an inside, along the longest edge of its box
    std::filesystem::path file;  ///< OpenVDB; empty: the scene itself is such a file
    std::string density;         ///< name of the grid; empty: "density", or the only one there is
    Rgb sigma_t{1, 1, 1};        ///< [1/m] where the density, times scale, is 1
    Rgb albedo{0.99f, 0.99f, 0.99f};
    std::string albedo_grid;  ///< name of a grid that says it instead; empty: `albedo` everywhere
    double scale = 1;         ///< of the density
    PhaseFunction phase;
    bool paper = false;  ///< fidelity "paper": [Premoze2003] as printed
    /// Grid of radiance per metre, or of temperatures of a black body; at most one of both.
    std::string emission, temperature;
    double emission_scale = 1;     ///< of radiance
    double temperature_scale = 1;  ///< [K] for a value of 1
    glm::dmat4 transform{1};  ///< affine: the file's world to the scene's, in units of the scene
};

/// A cloud layer that a media file places.
struct CloudEntry {
    std::string where;                      ///< in the media file, for messages: "clouds > 0"
    CloudLayer layer;                       ///< without thickness where a formula gives it
    std::optional<HeightFieldShape> shape;  ///< the formula
    double thickness = 0;                   ///< where the formula is 1 [m], > 0
};

/// A media file, checked.
struct MediaFile {
    std::string file;                       ///< for messages
    std::vector<MaterialMedium> materials;  ///< no name stands twice
    std::vector<VolumeEntry> volumes;
    std::vector<CloudEntry> clouds;  ///< at most kMaxLayers
    std::vector<EmitterGroup> emitter_groups;
    std::vector<std::filesystem::path> inputs;  ///< files read
    std::string sha256;                         ///< of their bytes, in reading order
};

}  // namespace opaline::formats
