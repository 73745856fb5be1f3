#pragma once

#include "tests/runtime/embed_gl/host/host_picture.h"

namespace opaline::test {

/// A host's picture of a cloud layer, bound: `a` is a pixel of a host whose sky is (1, 0.8, 0.5);
/// where its flag `wants_parts` is set, `a` is radiance + 2 glow and the distance, `b` the
/// transmittance and that of suns in blue. Its number `spread` is a pixel's angle. Throws as
/// `require`.
HostPicture make_layer_picture(HostApi api, const opaline_gl_layer& layer);

}  // namespace opaline::test
