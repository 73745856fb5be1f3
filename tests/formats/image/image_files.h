#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "formats/image/chromaticities.h"
#include "formats/image/exr.h"
#include "formats/image/image.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// How `make_exr` writes its file, by OpenEXR itself.
struct ExrStyle {
    int compression = 3;  ///< Imf::Compression; 3 is ZIP
    bool is_half = false;
    bool is_tiled = false;   ///< 16 x 16 tiles with mip levels
    bool is_grey = false;    ///< channel Y instead of R, G, B
    bool has_alpha = false;  ///< a channel A of 0.25
    bool has_layer = false;  ///< channels diffuse.R, diffuse.G, diffuse.B
    std::optional<Chromaticities> chromaticities = {};
    int min_x = 0, min_y = 0;
    Envmap envmap = Envmap::none;
    const char* prefix = "";  ///< put before the colour channels' names
};

std::string make_exr(const Image& image, const ExrStyle& style = {});

/// A file of two flat parts: "depth" with a channel Z, and "light", whose colours are `image`.
std::string make_exr_of_parts(const Image& image);

/// A path for a file of this test, unique per name.
std::filesystem::path temporary(const std::string& name);

std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);
std::span<const std::byte> as_bytes(const std::string& text);

/// The first diagnostic as one line.
std::string message(const Error& error);

/// What was read; throws the message of what was not.
template <class T>
T must(Result<T> read) {
    return read ? std::move(*read) : throw std::runtime_error(message(read.error()));
}
/// "accepted", or the message.
template <class T>
std::string refusal(const Result<T>& read) {
    return read ? "accepted" : message(read.error());
}

/// An image in which every value differs.
Image ramp(std::uint32_t width, std::uint32_t height);

}  // namespace opaline::formats
