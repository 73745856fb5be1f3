#pragma once

#include <vector>

#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/radiosity.h"

namespace opaline::runtime {

/// The ground and the base of a layer as cells that light each other. Of a layer that repeats one
/// period; otherwise the layer and a margin around it, beyond which there is no layer.
struct GroundCells {
    PlaneGrid grid;
    double low_x = 0, low_z = 0;  ///< the first corner [m]
    std::vector<RadiosityCell> cell;
    RadiosityCell outside;
};

/// Cells half as long as the base is high, or as few as kMostGroundCells allow along an axis; each
/// is a mean over kGroundSamples^2 points. Where the layer has no radiosity the albedo counts as 0:
/// light from the base reaches the ground, and none goes back. Precondition: all of `light` but its
/// grids is set. The result has the same bits for any number of threads.
GroundCells cut_ground(const LayerLight& light, unsigned threads);
inline constexpr std::uint32_t kMostGroundCells = 128, kGroundSamples = 4;

}  // namespace opaline::runtime
