#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "formats/image/image.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// Decodes a PNG of any colour type and depth to 8-bit sRGB with alpha. `name` is used in messages
/// only. Untrusted bytes are safe. Errors: bad_input.
Result<Image8> decode_png(std::span<const std::byte> bytes, const std::string& name);

/// `decode_png` of a file.
Result<Image8> read_png(const std::filesystem::path& path);

/// The bytes of an 8-bit sRGB PNG; without an alpha channel if every alpha is 255.
/// `name` is used in messages only. Errors: usage for an image without pixels, resource.
Result<std::string> encode_png(const Image8& image, const std::string& name);

/// Writes them. Errors: the same, and resource for a failed write.
Status write_png(const std::filesystem::path& path, const Image8& image);

}  // namespace opaline::formats
