#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/path_integral/volume_box.h"
#include "bake/reference/volume_space.h"

namespace opaline::bake {

/// Nodes of a cubic lattice, those near density alone.
struct DepthLattice {
    glm::dvec3 low{0};   ///< [m] of node (0, 0, 0)
    double spacing = 1;  ///< [m]
    glm::ivec3 count{0};
    std::vector<std::uint32_t> slot;  ///< by node, x fastest; formats::kNone: far from density
    std::vector<glm::vec3> position;  ///< [m] by slot
};

/// The box [m] in which density may be.
VolumeBox density_box(const VolumeSpace& space);

/// The shortest edge of a voxel [m].
double voxel_edge(const VolumeSpace& space);

/// Nodes as far apart as voxels, or farther where there would be more than `most` of them. Every
/// point with density has all eight nodes around it.
DepthLattice make_depth_lattice(const VolumeSpace& space, std::size_t most);

/// The eight nodes around a point, and their shares.
struct DepthNodes {
    std::array<std::uint32_t, 8> slot;
    std::array<double, 8>
        weight;  ///< sum 1, where there is density; 0 for nodes that are far from density
};
DepthNodes depth_nodes_around(const DepthLattice& lattice, glm::dvec3 x);

}  // namespace opaline::bake
