#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/sample_transport.h"
#include "bake/receivers/receiver.h"
#include "bake/scene/separate_bodies.h"

namespace opaline::bake {

/// A node over a run of samples (multiple/README.md, "Hierarchy").
struct ClusterNode {
    glm::vec3 low, high;  ///< bounding box of its samples [m]
    glm::vec3 centre;     ///< P of README.md: mean position, weighted by area and mean of E
    std::uint32_t first = 0, count = 0;  ///< samples
    std::uint32_t right = 0;  ///< second child; the first follows the node itself. 0: a leaf
    float norm = 0;           ///< ||sum of A_i E_i||, before truncation, with other light [m^2]
};

/// Samples in kd-order (kd_order.h), body by body, and for each node the sum of the light that
/// enters through it.
struct ClusterTree {
    std::vector<ClusterNode> nodes;  ///< depth-first; empty if there are no samples
    SeparateBodies bodies;
    /// The node over the samples of each body; kNoRoot where it has none. Empty: the first node is
    /// that of all.
    std::vector<std::uint32_t> roots;
    static constexpr std::uint32_t kNoRoot = 0xffffffffu;
    SparseVectors sums;  ///< of each node: sum over its samples of A_i E_i [m^2]
    std::vector<glm::vec3> position, normal;  ///< of the samples
    std::vector<float> area;
    SparseVectors samples;  ///< A_i E_i
    /// The same of other light (SampleTransport::other), or none.
    SparseVectors other_sums, other_samples;
    std::array<float, 3> other_factor{1, 1, 1};  ///< of other light: MediumProfile::all_orders
    double total_area = 0;
    double mean_norm = 0;  ///< RMS over the samples of ||E_i||, weighted by area
};

/// Sorts samples by the body that they belong to, those of each in kd-order.
void sort_by_body(const SeparateBodies& bodies, std::vector<SurfaceSample>& samples);

/// The tree over samples in kd-order; with several `bodies` as sort_by_body leaves them, a tree
/// for each body. It takes over their transport. Each node's sum adds its
/// samples' vectors and is truncated once, to `kept` entries,
/// and those of other light to `kept_of_light`.
ClusterTree build_cluster_tree(std::span<const SurfaceSample> samples, SampleTransport transport,
                               std::uint32_t cubemap_size, std::uint32_t kept,
                               const Context& context, std::uint32_t kept_of_light = 32,
                               SeparateBodies bodies = {});

}  // namespace opaline::bake
