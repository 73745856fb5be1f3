#pragma once

#include <vector>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::test {

/// What a host's shaders of installed functions show of each receiver, primitive by primitive: four
/// floats each, the first three as opaline_shade_from without flags for emitters at their own
/// strength. `gl`: made WITH_MESH, for images WITH_IMAGES, relit and looked at from `eye`. Throws
/// as `require`.
std::vector<float> draw_receivers(const opaline_asset* asset, const opaline_gl* gl, HostApi api,
                                  const float* eye);

}  // namespace opaline::test
