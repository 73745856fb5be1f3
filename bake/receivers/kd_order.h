#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Neighbours that gather together: one for each lane of a ray packet.
constexpr std::uint32_t kSamplesPerGroup = 16;
/// Neighbours in a leaf of the kd-tree: a quarter of a group. With half of one, a bake of 150 k
/// samples took 4 % longer.
constexpr std::uint32_t kSamplesPerLeaf = 4;

/// Samples in the first child of a node over `count` > kSamplesPerLeaf of them: half of its groups,
/// and of a group one leaf, so that both begin with a whole group or leaf.
std::uint32_t first_child_count(std::uint32_t count);

/// Indices of samples such that each node of a kd-tree, split by first_child_count where it is
/// longest down to kSamplesPerLeaf samples, is a run of them, depth-first.
std::vector<std::uint32_t> kd_order(std::span<const SurfaceSample> samples);

/// Puts samples into that order.
void sort_into_groups(std::vector<SurfaceSample>& samples);

}  // namespace opaline::bake
