#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/image/exr.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// The contents of an OpenEXR header that are checked before OpenEXR reads the file.
struct ExrHeader {
    std::int32_t min_x = 0, min_y = 0;  ///< data window
    std::uint32_t width = 0, height = 0;
    Envmap envmap = Envmap::none;
    bool is_rec709 = true;               ///< chromaticities absent or those of Rec. 709
    std::vector<std::string> full_size;  ///< channels that have a value for every pixel
    std::vector<std::string> subsampled;
};

/// Parses the header of `bytes` (a whole file). Refuses what is not supported and what could make
/// OpenEXR allocate far more than the file's size justifies: several parts, deep data, attributes
/// that overrun the file, huge windows, tiles, channel lists or chunk tables. Attributes that do
/// not matter here are renamed in place to a type unknown to OpenEXR, so that none of its attribute
/// parsers (previews, manifests, ...) runs on untrusted sizes. Errors: bad_input. `name` is used in
/// messages only.
Result<ExrHeader> check_exr_header(std::string& bytes, const std::string& name);

}  // namespace opaline::formats
