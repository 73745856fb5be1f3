#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/transport/direction_set.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// gather_irradiance with a factor for each band, traced once: `transport` holds
/// V max(0, n.w) f_b(n.w) band by band, 6 n n values each, `factor[b]` tabulates f_b at evenly
/// spaced cosines from 0 to 1, at least two of them. Returns the number of rays: none where there
/// is nothing to hit.
std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport);

}  // namespace opaline::bake
