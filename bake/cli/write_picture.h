#pragma once

#include <string>

#include "formats/opal/result.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// Radiance times 2^exposure as OpenEXR, or tone-mapped as PNG: by the ending of the path, which is
/// one of the two. Errors: resource.
formats::Status write_picture(const std::string& path, const runtime::Picture& picture,
                              float exposure, runtime::ToneMap map = runtime::ToneMap::neutral);

}  // namespace opaline::cli
