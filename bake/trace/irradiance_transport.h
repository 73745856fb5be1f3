#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// gather_irradiance with one factor per band and rays traced once. `transport`: V max(0, n.w)
/// f_b(n.w) band by band, 6 n n values each. `factor[b]` tabulates f_b at two or more evenly spaced
/// cosines from 0 to 1. Returns the number of rays: none where there is nothing to hit.
std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport);

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

/// Integral of the cosine over a cell of a block [sr]; <= 0 below the horizon.
inline float cosine_integral(const DirectionBlock& block, std::uint32_t lane, glm::vec3 normal) {
    return normal.x * block.moment_x[lane] + normal.y * block.moment_y[lane] +
           normal.z * block.moment_z[lane];
}

/// True if the whole block is below the horizon, or if there is no normal.
bool is_below(const DirectionBlock& block, glm::vec3 normal);

/// Traces a block from `packet`'s origins. Adds the cosine integrals of unoccluded cells, times the
/// boundary's transmittance (gather_irradiance), to the texels of `transport`. Returns the number
/// of rays: 0 in an empty scene.
std::uint64_t trace_block(const RayScene& rays, const DirectionBlock& block, glm::vec3 normal,
                          std::span<const float> transmittance, RayPacket& packet,
                          std::span<float> transport);

/// The same for a block that is known to be unoccluded.
void fill_block(const DirectionBlock& block, glm::vec3 normal, std::span<const float> transmittance,
                std::span<float> transport);

/// Turns integrals over texels into means.
void divide_by_solid_angle(const DirectionSet& directions, std::span<float> transport);

}  // namespace opaline::bake
