#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/visibility/direction_set.h"
#include "bake/visibility/ray_scene.h"

namespace opaline::bake {

/// gather_irradiance with one factor per band and rays traced once. `transport`: V max(0, n.w)
/// f_b(n.w) band by band, 6 n n values each. `factor[b]` tabulates f_b at two or more evenly spaced
/// cosines from 0 to 1. Returns the number of rays.
std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport);

}  // namespace opaline::bake
