#pragma once

#include <cstdint>

#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// What both backends refuse: picture sizes outside [1, kMaxPictureSize], S outside [1, 8], a
/// field of view outside (0, 180), a near plane that is not positive, non-finite numbers.
formats::Status check_camera(const Camera& camera, std::uint32_t supersampling);

}  // namespace opaline::runtime
