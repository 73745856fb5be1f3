#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/image/image.h"
#include "formats/opal/result.h"

namespace opaline::formats {

struct HdrImage {
    Image image;                       ///< finite, >= 0
    std::vector<Diagnostic> warnings;  ///< header lines that change the meaning of the values
};

/// Decodes a Radiance picture: RGBE, flat, old or new run-length encoding, in each of
/// its eight orientations.
/// A pixel is mantissa / 256 * 2^(exponent - 128), without the half step that Radiance itself adds,
/// as most programs read it; values are divided by the EXPOSURE lines of the header.
/// `name` is used in messages only. Untrusted bytes are safe. Errors: bad_input.
Result<HdrImage> decode_hdr(std::span<const std::byte> bytes, const std::string& name);

}  // namespace opaline::formats
