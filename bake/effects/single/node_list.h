#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/single/light_columns.h"
#include "bake/effects/single/ray_single.h"

namespace opaline::bake {

/// Interior nodes of many receivers, in two lists: nodes to look up in views, and nodes that need
/// rays (on creases and where shells overlap).
struct NodeList {
    /// A run of receivers with nodes that are looked up together.
    struct Block {
        std::uint32_t receiver, receivers;  ///< first of them, how many
    };
    std::vector<InteriorNode> node;    ///< looked up, receiver by receiver
    std::vector<std::uint32_t> first;  ///< those of receiver r in [first[r], first[r + 1])
    ColumnPoints points;               ///< the same nodes
    std::vector<Block> blocks;         ///< all receivers
    std::size_t largest_block = 0;     ///< [nodes]
    /// A node that a view cannot decide alone.
    struct Hard {
        InteriorNode node;
        std::uint32_t receiver;
        bool crease;  ///< on a crease: a view decides if all layers are pixels away; else rays
                      ///< decide
    };
    std::vector<Hard> hard;    ///< by receiver, ascending
    std::vector<float> scale;  ///< per receiver: upper bound of T / g_k
    float throughput = 0;      ///< the largest Ft J at any angle
};

/// The nodes of `points`. `centre`: BodyMesh::centre.
NodeList collect_nodes(const RayScene& rays, const SingleMedium& medium, glm::vec3 centre,
                       std::span<const BodyPoint> points, const Context& context);

}  // namespace opaline::bake
