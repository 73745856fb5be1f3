#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/trace/density/density_space.h"

namespace opaline::bake {

/// The albedo of each node of a volume, relative to DensityVolume::albedo, in [0, 1]: 1 where that
/// holds everywhere. It is the mean over voxels nearer than the next node, linear in their distance
/// along each axis and weighted by density. A file has one albedo a volume; rows times these
/// shares, linear between nodes, scatter as much as all voxels do.
std::vector<glm::vec3> node_albedo_shares(const DensityVolume& volume, const NodeLattice& lattice);

/// Error of albedos interpolated between nodes: RMS difference to the voxels, weighted by density,
/// relative to their RMS; 0 for a constant albedo. At most 1024 bricks are sampled. `spacing` as in
/// NodeLattice.
double lost_albedo_detail(const DensityVolume& volume, std::uint32_t spacing);

}  // namespace opaline::bake
