#pragma once

#include <cstdint>
#include <span>

#include "bake/receivers/receiver.h"
#include "bake/transport/direction_set.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// Irradiance transport E(x, w) = V(x, w) max(0, n.w) ([Wang2005] eq. (8) with Ft = 1, a diffuse
/// surface): `transport[j]` is its mean over texel j, 6 n n values, unit 1.
///
/// 2 x 2 visibility rays per texel; the cosine under each ray is integrated over its subtexel
/// exactly (texel_moments), so an unoccluded receiver has no quadrature error except along its
/// horizon, where a subtexel counts as the positive part of its integral. `transmittance`, if not
/// empty, tabulates Ft(eta, n.w) at evenly spaced cosines from 0 to 1; each ray is weighted by it.
/// Returns the number of rays traced. A receiver without a normal gathers nothing.
std::uint64_t gather_irradiance(const RayScene& rays, const DirectionSet& directions,
                                const Receiver& receiver, std::span<float> transport,
                                std::span<const float> transmittance = {});

}  // namespace opaline::bake
