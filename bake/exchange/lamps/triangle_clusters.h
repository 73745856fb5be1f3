#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A range of triangles that is halved by place over and over.
struct TriangleCluster {
    std::uint32_t first = 0, count = 0;  ///< of TriangleClusters::order
    std::size_t base = 0;                ///< of its chart, into TriangleClusters::is_patch
    std::size_t node = 0;                ///< from there

    /// Both halves of a cluster of more than one triangle.
    TriangleCluster half(bool is_second) const {
        const std::uint32_t split = count / 2;
        return {is_second ? first + split : first, is_second ? count - split : split, base,
                2 * node + (is_second ? 2 : 1)};
    }
};

/// A primitive's triangles in charts, and charts in clusters.
struct TriangleClusters {
    std::vector<std::uint32_t> order;  ///< numbers of triangles; clusters are ranges
    std::vector<TriangleCluster> charts;
    /// For each cluster of more than one triangle: whether it and its halves are connected, so that
    /// one value of irradiance may represent it.
    std::vector<bool> is_patch;

    bool joins(const TriangleCluster& cluster) const {
        return is_patch[cluster.base + cluster.node];
    }
};

/// Charts grow from the first triangle left over common edges, where corners lie at the same
/// places, as long as normals are within 25 degrees of its. Triangles without area are alone.
TriangleClusters cluster_triangles(const formats::Primitive& primitive);

}  // namespace opaline::bake
