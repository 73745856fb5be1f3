#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/smooth_rows.h"
#include "bake/effects/volumes/volume_walks.h"

namespace opaline::bake {

/// Memory [bytes] of the rows of all nodes of a volume before they are smoothed; 0: they are not,
/// where walks are many by quality, or the rows too many to keep. `row`: bands times cells.
double walked_row_bytes(Quality quality, double nodes, double terms, double row);

/// What walks found at the nodes of one layout, and how to smooth it.
struct WalkedLayout {
    std::vector<WalkedNode> nodes;  ///< empty where rows are not smoothed
    std::vector<NodePairs> pairs;
    Smoothing smoothing;
};

/// Noise that is left in a volume's rows of multiple scattering, relative (Smoothing::noise).
struct RowNoise {
    std::uint32_t volume = 0;  ///< before volumes were parted
    double noise = 0;
};

/// The walks of all layouts whose rows are smoothed, in their order. Counts `rays`.
std::vector<WalkedLayout> walk_nodes(const VolumeJob& job, const PlacedNodes& nodes,
                                     const VolumeWalkSpace& walks, const Context& context,
                                     std::uint64_t& rays);

/// Of a node among all.
WalkReceiver walk_receiver(const VolumeJob& job, const PlacedNodes& nodes, std::size_t number);

}  // namespace opaline::bake
