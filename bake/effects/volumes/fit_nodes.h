#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Nodes of a lattice one after the other along an axis, with no surface between.
using NodeLine = std::vector<std::uint32_t>;

/// All lines of three nodes or more along each axis of a lattice. `to_scene` as of its grid. Counts
/// `rays`.
std::array<std::vector<NodeLine>, 3> find_node_lines(const NodeLattice& lattice,
                                                     const glm::dmat4& to_scene,
                                                     const RayScene& surfaces, std::uint64_t& rays);

/// Turns means over tents around nodes, as wide as to the next ones, into values whose linear
/// interpolation has these means: along each axis
///
///     (c_i-1 + 4 c_i + c_i+1) / 6 = b_i
///
/// and c = b at the ends of lines. What is narrower than nodes are apart is as bright in all and
/// not wider than it need be. `values`: `terms` a node, the first of them >= 0; it stays so.
void fit_tent_means(const std::array<std::vector<NodeLine>, 3>& lines, std::size_t terms,
                    std::span<glm::vec3> values);

}  // namespace opaline::bake
