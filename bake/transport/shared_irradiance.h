#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/transport/direction_set.h"
#include "bake/transport/ray_scene.h"

namespace opaline::bake {

/// What receivers that share rays look through: one ray a texel, at four places that they take
/// turns in.
struct SharedDirections {
    std::array<DirectionSet, 4> sets;
    std::vector<std::vector<std::uint32_t>>
        beside;  ///< of each block: those across its edges, at least
};

SharedDirections make_shared_directions(std::uint32_t cubemap_size);

/// gather_irradiance for up to sixteen receivers next to each other, with fewer rays. Of each block
/// of cells every cell is probed by one of them. Where all probes agree, all cells are taken to be
/// like that for all receivers; elsewhere each receiver traces its own. Beside what differs, three
/// more probes of every cell, each by another receiver through another quarter, must agree too.
/// What they all miss is narrower than a quarter of a cell throughout, or seen by few of the
/// receivers only.
///
/// `transport`: one receiver after the other, 6 n n values each. Receiver i looks through set i
/// % 4. Returns the number of rays.
std::uint64_t gather_irradiance_together(const RayScene& rays, const SharedDirections& directions,
                                         std::span<const Receiver> receivers,
                                         std::span<float> transport,
                                         std::span<const float> transmittance = {});

}  // namespace opaline::bake
