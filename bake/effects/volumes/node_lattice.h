#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/sparse_rows.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

/// Where the light of one volume is baked: nodes on the voxels whose coordinates are multiples of
/// `spacing`, wherever there is density in one of the eight cells of the lattice around them.
/// Bricks and corners are as in formats/opal/volumes.h.
struct NodeLattice {
    std::uint32_t spacing = 1;          ///< voxels: 1, 2, 4 or 8
    glm::ivec3 first_brick{0};          ///< lowest corner of the table
    glm::ivec3 extent{0};               ///< bricks along each axis
    std::vector<std::uint32_t> table;   ///< numbers of bricks, or formats::kNoBrick; x fastest
    std::vector<glm::ivec3> brick;      ///< coordinates of each brick, in the order of the table
    std::vector<std::uint32_t> corner;  ///< nodes at the (8 / spacing + 1)^3 corners of each brick,
                                        ///< or formats::kNoNode; x fastest
    std::vector<glm::ivec3> node;       ///< voxel of each node, neighbours together
};

/// Bricks are those of the grid, and the ones below them into which density between voxels reaches;
/// likewise of `glow`, without nodes where no density is. `spacing`: 1, 2, 4 or 8. Precondition:
/// `glow` has the same table as the grid, or is empty.
NodeLattice make_node_lattice(const formats::SparseGrid<float>& grid, std::uint32_t spacing,
                              const formats::SparseGrid<glm::vec3>& glow = {});

/// The eight nodes around a point, with trilinear weights.
struct NodesAround {
    std::array<std::uint32_t, 8> node{};  ///< kNoNode where there is no density near it
    std::array<float, 8> weight{};        ///< sum 1
    bool found = false;                   ///< whether a brick is there at all
};

/// `index`: in index coordinates. Where there is density all eight nodes are there.
NodesAround nodes_around(const NodeLattice& lattice, glm::vec3 index);

/// The largest spacing of 1, 2, 4 and 8 at which the typical extinction of voxels with densities
/// `values`, weighted by itself, times the distance between nodes is at most `depth` [1]; 1 if
/// there is none. `to_scene`: SparseGrid::to_scene.
std::uint32_t choose_spacing(std::span<const float> values, const glm::dmat4& to_scene,
                             double sigma_t, double depth);

/// The mean density around each node, linear in the distance to the next one along each axis,
/// relative to the largest of them.
std::vector<float> node_densities(const formats::SparseGrid<float>& density,
                                  const NodeLattice& lattice);

/// RMS over directions and bands of a row of V on a cube map of n x n texels: how much of the light
/// of a node reaches eyes all around, because depths are the same both ways.
float mean_visibility(const formats::SparseRow& attenuated, std::uint32_t n);

}  // namespace opaline::bake
