#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "formats/image/exr_header.h"

namespace opaline::formats {

/// The channels that hold the colours of an OpenEXR file.
struct ExrLayer {
    std::size_t part = 0;
    std::string name;  ///< "ViewLayer.Combined"; empty for channels without a layer
    std::optional<std::string> red, green, blue;  ///< channels' names; none: its values are 0
    bool is_grey = false;                         ///< `red` is the luminance of all three
};

/// Chooses the layer to read. Layers with all of R, G and B at full resolution (or red, green,
/// blue, in any case) come first, then those of a luminance Y (not the Y of a vector X, Y, Z), then
/// the channels without a layer if they hold one of R, G and B. Among equals: the first part; in it
/// the channels without a layer, then one that is called combined, beauty or rgba, then the first
/// in the file. None if no part that can be read has colours.
std::optional<ExrLayer> choose_layer(std::span<const ExrHeader> parts);

/// How many layers of colours `parts` hold, alternatives to the chosen one included.
std::size_t count_color_layers(std::span<const ExrHeader> parts);

}  // namespace opaline::formats
