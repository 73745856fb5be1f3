#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/bounce_ends.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/scatterers.h"

namespace opaline::bake {

/// A node of the tree and its share of a point's irradiance: in all bands, or in one.
struct NodeWeight {
    static constexpr std::uint32_t kAllBands = 3;
    std::uint32_t node = 0;
    float weight = 0;
    std::uint32_t band = kAllBands;
};
/// Appends a share that may differ between bands.
void append_weight(std::uint32_t node, const formats::Rgb& share, std::vector<NodeWeight>& weights);

/// Further results of a point's rays.
struct BounceGather {
    std::uint64_t rays = 0;
    float nearness = 0;  ///< [1/m^2], mean of 1 / length^2; 0 of rays that meet nothing
    float met = 0;       ///< share of the irradiance whose rays meet something, sending or black
};

/// Which rows answer a ray. Benchmarks compare them.
enum class LookUp : std::uint8_t {
    kernel,   ///< nodes under a Gaussian over the footprint of the ray's cell
    node,     ///< the node as large as the footprint, toward the ray's end
    nearest,  ///< the scatterer next to the ray's end
};

/// The footprint on a surface of the cell of a ray that meets it: the middle direction of the cell
/// is moved to the plane of the facet, and with it what the direction changes over the cell's
/// widths (transfer of path differentials: dy = t (dD - D (n.dD) / (n.D))). Where that plane is
/// met far from the hit or not at all, the footprint is around the hit.
FootprintKernel footprint_of(glm::vec3 origin, const BounceEnd& end, const BounceCell& cell,
                             const Frame& frame);

/// The irradiance at a point as a sum over nodes, ascending: E = sum of weight * mean B of the
/// node,
///     E = 1/N sum over N cells of cosine-distributed rays of B over the footprint of each.
/// The ray decides whether a surface is seen and which; the mean of B over its cell has no noise of
/// where in the cell it went. Rays that end on media or narrow lobes go on as these mirror them,
/// and read the scatterer or the texel of the sky where they end; the rest of their light is that
/// of the surface itself (share_of_radiosity, share_beside_lobe). Overwrites `weights`.
BounceGather weigh_bounces(const BounceSpace& space, const BounceTree& tree, const Receiver& at,
                           const BounceGrid& grid, std::uint64_t seed,
                           std::vector<NodeWeight>& weights, LookUp look_up = LookUp::kernel);

/// Adds sum of weight * row of the node to `rows`, one as long as those of the tree. Rows of one
/// band have no weights that differ between bands.
void add_node_rows(const BounceTree& tree, std::span<const NodeWeight> weights,
                   std::span<float> rows);

/// Adds `bands` planes of 6 m m Haar coefficients to planes of 6 n n, n >= m: the same map in
/// smaller texels.
void add_to_finer(std::span<const float> from, std::uint32_t m, std::span<float> to,
                  std::uint32_t n, std::uint32_t bands);

}  // namespace opaline::bake
