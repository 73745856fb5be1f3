#include "bake/exchange/lamps/triangle_clusters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <numeric>
#include <span>
#include <tuple>

namespace opaline::bake {
namespace {

constexpr double kLeastCosine = 0.9063;  // 25 degrees

using Corners = std::array<std::uint32_t, 3>;

// The same number for corners at the same place.
std::vector<Corners> weld_corners(const formats::Primitive& primitive) {
    const std::vector<glm::vec3>& at = primitive.position;
    std::vector<std::uint32_t> sorted(at.size());
    std::iota(sorted.begin(), sorted.end(), 0u);
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        return at[a].x != at[b].x   ? at[a].x < at[b].x
               : at[a].y != at[b].y ? at[a].y < at[b].y
                                    : at[a].z < at[b].z;
    };
    std::sort(sorted.begin(), sorted.end(), is_before);
    std::vector<std::uint32_t> place(at.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        place[sorted[i]] =
            i > 0 && !is_before(sorted[i - 1], sorted[i]) ? place[sorted[i - 1]] : sorted[i];
    }
    std::vector<Corners> corners(primitive.index.size() / 3);
    for (std::size_t t = 0; t < corners.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            corners[t][k] = place[primitive.index[3 * t + k]];
        }
    }
    return corners;
}

/// A triangle on an edge, by its ends.
struct EdgeSide {
    std::uint32_t low = 0, high = 0, triangle = 0;
    bool operator<(const EdgeSide& other) const {
        return std::tie(low, high, triangle) < std::tie(other.low, other.high, other.triangle);
    }
    bool is_beside(const EdgeSide& other) const { return low == other.low && high == other.high; }
};

// Pairs of triangles with a common edge, each both ways, sorted: of a fan around an edge its
// neighbours in the list.
std::vector<std::array<std::uint32_t, 2>> find_neighbours(std::span<const Corners> corners) {
    std::vector<EdgeSide> edges;
    edges.reserve(3 * corners.size());
    for (std::uint32_t t = 0; t < corners.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = corners[t][k], b = corners[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), t});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<std::uint32_t, 2>> pairs;
    pairs.reserve(edges.size());
    for (std::size_t i = 1; i < edges.size(); ++i) {
        if (!edges[i].is_beside(edges[i - 1])) continue;
        pairs.push_back({edges[i - 1].triangle, edges[i].triangle});
        pairs.push_back({edges[i].triangle, edges[i - 1].triangle});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

class ClusterMaker {
  public:
    ClusterMaker(const formats::Primitive& primitive, TriangleClusters& clusters)
        : corners_(weld_corners(primitive)),
          clusters_(clusters),
          parent_(primitive.position.size()) {
        const std::size_t count = corners_.size();
        normal_.reserve(count);
        centre_.reserve(count);
        for (std::size_t t = 0; t < count; ++t) {
            const std::uint32_t* const i = &primitive.index[3 * t];
            const glm::dvec3 a(primitive.position[i[0]]), b(primitive.position[i[1]]),
                c(primitive.position[i[2]]);
            const glm::dvec3 across = glm::cross(b - a, c - a);
            const double twice = glm::length(across);
            normal_.push_back(twice > 0 ? across / twice : glm::dvec3(0));
            centre_.push_back((a + b + c) / 3.0);
        }
    }

    void make() {
        grow_charts();
        for (TriangleCluster& chart : clusters_.charts) {
            chart.base = clusters_.is_patch.size();
            std::size_t nodes = 1;
            while (nodes < 2 * std::size_t{chart.count})
                nodes *= 2;
            clusters_.is_patch.resize(chart.base + nodes, false);
            divide(chart);
        }
    }

  private:
    void grow_charts() {
        const auto pairs = find_neighbours(corners_);
        std::vector<bool> is_taken(corners_.size(), false);
        clusters_.order.reserve(corners_.size());
        for (std::uint32_t seed = 0; seed < corners_.size(); ++seed) {
            if (is_taken[seed]) continue;
            const auto first = static_cast<std::uint32_t>(clusters_.order.size());
            clusters_.order.push_back(seed);
            is_taken[seed] = true;
            for (std::uint32_t i = first; i < clusters_.order.size(); ++i) {
                const std::uint32_t from = clusters_.order[i];
                auto pair = std::lower_bound(pairs.begin(), pairs.end(),
                                             std::array<std::uint32_t, 2>{from, 0});
                for (; pair != pairs.end() && (*pair)[0] == from; ++pair) {
                    const std::uint32_t next = (*pair)[1];
                    if (is_taken[next] || glm::dot(normal_[seed], normal_[next]) < kLeastCosine) {
                        continue;
                    }
                    is_taken[next] = true;
                    clusters_.order.push_back(next);
                }
            }
            clusters_.charts.push_back(
                {first, static_cast<std::uint32_t>(clusters_.order.size()) - first, 0, 0});
        }
    }

    // Whether it is a patch.
    bool divide(const TriangleCluster& cluster) {
        if (cluster.count == 1) return true;
        const TriangleCluster first = cluster.half(false), second = cluster.half(true);
        const auto begin = clusters_.order.begin() + static_cast<std::ptrdiff_t>(cluster.first);
        const int axis = longest_axis(cluster);
        std::nth_element(begin, begin + first.count, begin + cluster.count,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return centre_[a][axis] != centre_[b][axis]
                                        ? centre_[a][axis] < centre_[b][axis]
                                        : a < b;
                         });
        const bool is_first = divide(first), is_second = divide(second);
        const bool is_patch = is_first && is_second && is_connected(cluster);
        clusters_.is_patch[cluster.base + cluster.node] = is_patch;
        return is_patch;
    }

    int longest_axis(const TriangleCluster& cluster) const {
        glm::dvec3 low(1e300), high(-1e300);
        for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
            low = glm::min(low, centre_[clusters_.order[i]]);
            high = glm::max(high, centre_[clusters_.order[i]]);
        }
        const glm::dvec3 size = high - low;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }

    std::uint32_t find(std::uint32_t corner) {
        while (parent_[corner] != corner) {
            parent_[corner] = parent_[parent_[corner]];
            corner = parent_[corner];
        }
        return corner;
    }

    bool is_connected(const TriangleCluster& cluster) {
        const std::span<const std::uint32_t> triangles =
            std::span(clusters_.order).subspan(cluster.first, cluster.count);
        for (const std::uint32_t t : triangles) {
            for (const std::uint32_t corner : corners_[t])
                parent_[corner] = corner;
        }
        for (const std::uint32_t t : triangles) {
            for (const std::uint32_t other : {corners_[t][1], corners_[t][2]}) {
                parent_[find(other)] = find(corners_[t][0]);
            }
        }
        const std::uint32_t root = find(corners_[triangles.front()][0]);
        return std::ranges::all_of(triangles,
                                   [&](std::uint32_t t) { return find(corners_[t][0]) == root; });
    }

    std::vector<Corners> corners_;
    TriangleClusters& clusters_;
    std::vector<std::uint32_t> parent_;  // of welded corners
    std::vector<glm::dvec3> normal_;     // unit; 0 without area
    std::vector<glm::dvec3> centre_;
};

}  // namespace

TriangleClusters cluster_triangles(const formats::Primitive& primitive) {
    TriangleClusters clusters;
    ClusterMaker(primitive, clusters).make();
    return clusters;
}

}  // namespace opaline::bake
