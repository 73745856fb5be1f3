#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/trace/ray_scene.h"
#include "formats/sparse_grid.h"

namespace opaline::bake {

/// What the walks of a node found.
struct WalkedNode {
    std::vector<float> rows;  ///< T_k; term after term, band after band
    /// The same in few cells, of every other walk: two independent estimates.
    std::array<std::vector<float>, 2> half;
};

/// Rows of `planes` maps of n x n cells a face in means over at most 2 x 2 a face.
std::vector<float> reduce_rows(std::span<const float> rows, std::size_t planes, std::uint32_t n);

/// The neighbours of a node along edges, diagonals of faces and of cells, those opposite each other
/// in pairs. A pair counts where both are there, no surface is between, and densities around both
/// are the node's own within a quarter: where density changes, light bends.
struct NodePairs {
    static constexpr std::size_t kCount = 13;
    std::array<std::array<std::uint32_t, 2>, kCount> node{};  ///< formats::kNoNode twice: not there
};

/// Of all nodes of a lattice; `density` around each, `to_scene` as of its grid.
std::vector<NodePairs> find_node_pairs(const NodeLattice& lattice, std::span<const float> density,
                                       const glm::dmat4& to_scene, const RayScene& rays);

/// Weight of a neighbour along an edge over that of the node itself, by degree of the row; squared
/// and cubed for those across faces and cells.
using SmoothingWeights = std::array<float, 5>;

/// How rows are smoothed, and what is left of their noise: RMS over all views, bands and few
/// directions of light, relative to that of the light.
struct Smoothing {
    SmoothingWeights weights{};
    double noise = 0;
};

/// The weights with which light between nodes is least wrong, by cross-validation. Of two halves a
/// and b of the walks, smoothed by S, with N = mean of (S a - S b)^2 / 4 the noise of their mean,
///     bias^2 = mean of ((S a - b)^2 + (S b - a)^2) / 2 - 2 N
/// but for a constant, and bias^2 + (2/3)^3 N is least: linear interpolation along three axes
/// leaves 8/27 of what is independent from node to node. Nodes count by their density. The same
/// bits for any number of threads.
Smoothing choose_smoothing(std::span<const WalkedNode> nodes, std::span<const NodePairs> pairs,
                           std::span<const float> density, std::uint32_t terms,
                           const Context& context);

/// The rows of a node as the mean over it and its pairs. Where light changes linearly from node to
/// node this changes nothing but noise.
std::vector<float> smooth_rows(std::span<const WalkedNode> nodes, std::span<const NodePairs> pairs,
                               std::size_t node, const SmoothingWeights& weights,
                               std::uint32_t terms);

}  // namespace opaline::bake
