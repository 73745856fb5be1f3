#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// The `envmap` attribute of an OpenEXR file: how its pixels map to directions.
enum class Envmap { none, lat_long, cube };

struct ExrImage {
    Image image;  ///< linear Rec. 709; values may be negative, infinite or NaN
    Envmap envmap = Envmap::none;
    std::vector<Diagnostic> warnings;  ///< impossible chromaticities, other layers
};

/// Decodes an OpenEXR file: scan lines or tiles (first level); HALF, FLOAT or UINT; every
/// compression. Of several layers or parts, the one with colours that exr_layer.h says. Colours of
/// other chromaticities are converted to Rec. 709 (chromaticities.h), without clamping.
/// `name` is used in messages only. Untrusted bytes are safe: the header is checked before
/// OpenEXR sees it. Errors: bad_input.
Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name);

/// Decodes one channel of such a file: the first of `names` that a part holds at full resolution.
/// Errors: bad_input; also if it holds none of them, or has more than `most_side` pixels on a side,
/// which is found before any is read.
Result<ScalarImage> decode_exr_channel(std::span<const std::byte> bytes, const std::string& name,
                                       std::initializer_list<const char*> names,
                                       std::uint32_t most_side);

/// `decode_exr` of a file, without its warnings.
Result<Image> read_exr(const std::filesystem::path& path);

/// Writes 32-bit float RGB, ZIP-compressed, with Rec. 709 chromaticities; `envmap` is stated as an
/// attribute unless it is `none`. Errors: usage for an empty image, resource for a failed write.
Status write_exr(const std::filesystem::path& path, const Image& image,
                 Envmap envmap = Envmap::none);

/// Writes the map of an environment. `none`: in our own convention without an attribute, that is a
/// lat-long map with +X in its centre (resampled if it is oriented otherwise), or for a cube the
/// vertical strip of its six faces. `lat_long`: in OpenEXR's lat-long convention with its
/// attribute, one column wider because the first and the last coincide (a cube becomes a map of
/// 4n x 2n). `cube` is refused. Discs are refused too, as pixels cannot hold them: rasterise first.
/// Errors: usage, resource.
Status write_exr(const std::filesystem::path& path, const Environment& environment,
                 Envmap envmap = Envmap::none);

}  // namespace opaline::formats
