#pragma once

#include <cstdint>

#include "formats/opal/clouds.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// The default view of a cloud layer that has nothing else in front of it: from the height of a
/// standing person above the centre's ground, 12 degrees up, away from 30 degrees from +Z toward
/// +X. The target lies at the layer's base. A layer that does not repeat is looked at a quarter of
/// its size away at most.
Camera frame_layer(const formats::LayerRecord& layer, float fov_y, std::uint32_t width,
                   std::uint32_t height);

}  // namespace opaline::runtime
