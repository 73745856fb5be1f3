#pragma once

#include <cstdint>
#include <vector>

#include "bake/effects/interreflection/bounce_gather.h"

namespace opaline::bake {

/// Nodes that a gather looked at, and those that its point does not see.
struct HiddenNodes {
    std::uint64_t looked_at = 0, hidden = 0;
};

/// weigh_bounces with LookUp::kernel, but without the tilt of weights; with `only_seen` a ray to
/// the centre of each node decides whether it counts ([Suykens2001], section 5: visibility within a
/// footprint). Where none is seen, the scatterer next to the ray's end answers.
HiddenNodes weigh_seen_nodes(const formats::Scene& scene, const RayScene& rays,
                             const BounceTree& tree, const Receiver& at, const BounceGrid& grid,
                             std::uint64_t seed, bool only_seen, std::vector<NodeWeight>& weights);

}  // namespace opaline::bake
