#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/image/chromaticities.h"
#include "formats/image/exr.h"
#include "formats/opal/result.h"

namespace opaline::formats {

/// The contents of the header of one part of an OpenEXR file, checked before OpenEXR reads it.
struct ExrHeader {
    std::int32_t min_x = 0, min_y = 0;  ///< data window
    std::uint32_t width = 0, height = 0;
    Envmap envmap = Envmap::none;
    bool is_deep = false;  ///< several samples a pixel: not read
    std::optional<Chromaticities> chromaticities;
    std::vector<std::string> full_size;  ///< channels that have a value for every pixel
    std::vector<std::string> subsampled;
};

/// Parses the headers of `bytes` (a whole file), one for each part; there is one at least. Refuses
/// what is not supported and what could make OpenEXR allocate far more than the file's size
/// justifies: attributes that overrun the file, huge windows, tiles, channel lists or chunk tables,
/// and a file that is deep data alone. Attributes that do not matter here are renamed in place to a
/// type unknown to OpenEXR, so that none of its attribute parsers (previews, manifests, ...) runs
/// on untrusted sizes. Errors: bad_input. `name` is used in messages only.
Result<std::vector<ExrHeader>> check_exr_headers(std::string& bytes, const std::string& name);

}  // namespace opaline::formats
