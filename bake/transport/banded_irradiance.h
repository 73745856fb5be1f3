#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/transport/direction_set.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// gather_irradiance with one factor per band and rays traced once. `transport`: V max(0, n.w)
/// f_b(n.w) band by band, 6 n n values each. `factor[b]` tabulates f_b at two or more evenly spaced
/// cosines from 0 to 1. Returns the number of rays: none where there is nothing to hit.
std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport);

}  // namespace opaline::bake
