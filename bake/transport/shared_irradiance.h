#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/transport/direction_set.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// Directions of receivers that share rays: one ray per texel, in four sets, one for each quarter
/// of a texel.
struct SharedDirections {
    std::array<DirectionSet, 4> sets;
    std::vector<std::vector<std::uint32_t>>
        beside;  ///< neighbours of each block: at least those across its edges
};

SharedDirections make_shared_directions(std::uint32_t cubemap_size);

/// gather_irradiance for up to sixteen neighbouring receivers, with fewer rays. One of the
/// receivers probes each cell of a block. Where all probes of the block agree, their result holds
/// for all cells and receivers. Elsewhere each receiver traces its own rays. Blocks beside such a
/// block must pass three more probes of every cell, each by another receiver through another
/// quarter. An occluder is missed only if it is narrower than a quarter of a cell, or seen by few
/// of the receivers.
///
/// `transport`: one receiver after the other, 6 n n values each. Receiver i looks through set i
/// % 4. Returns the number of rays.
std::uint64_t gather_irradiance_together(const RayScene& rays, const SharedDirections& directions,
                                         std::span<const Receiver> receivers,
                                         std::span<float> transport,
                                         std::span<const float> transmittance = {});

}  // namespace opaline::bake
