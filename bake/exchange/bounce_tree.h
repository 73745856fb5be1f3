#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/surface_side.h"
#include "bake/trace/coded_rows.h"
#include "formats/scene.h"

namespace opaline::bake {

struct Scatterer;

/// Cube map of bounced light, which is smooth: RESULTS.md, "Interreflection".
inline constexpr std::uint32_t kBounceCubemap = 8;

/// Where a footprint is on a surface. Offsets from its centre, in its own widths: their dot
/// products with three axes, the third normal to the surface.
struct FootprintKernel {
    glm::vec3 centre{0};                      ///< [m]
    glm::vec3 across{0}, along{0}, above{0};  ///< [1/m]
    glm::vec3 extent{0};                      ///< [m], of a width along the axes of the world
    float steepest = 0;                       ///< [1/m], longest that any of the first two is
    float area = 0;                           ///< [m^2], > 0
};

/// Of an openness in [0, 1]: a logarithm to base 2.
struct Brightness {
    static constexpr float kDark = 0.05f;
    float octaves = 0;

    float openness() const { return std::exp2(octaves) - kDark; }
};
inline Brightness brightness_of(float openness) {
    return {std::log2(openness + Brightness::kDark)};
}
/// 1 of equal ones, 0 where one is twice the other.
inline float similarity(Brightness a, Brightness b) {
    return std::max(0.0f, 1 - std::abs(a.octaves - b.octaves));
}

/// kd-trees over scatterers, one for each material, side and nearest axis of the normal, so that
/// the two sides of a thin part never mix. Every node has a row: the mean of its scatterers'.
/// Texels of the sky have nodes as well, which no search finds; they are dark where rows are no
/// cube maps. So have irradiances of scatterers with narrow lobes.
class BounceTree {
  public:
    /// Nodes that a search sets aside: at most as many as a tree is deep.
    static constexpr std::size_t kMostWaiting = 512;

    /// `materials`: of the scene. Rows of `row_size` floats are 0 until set_rows.
    BounceTree(std::span<const Scatterer> scatterers, std::size_t materials, std::size_t row_size);

    /// `rows`: of all scatterers, then of their irradiances (number_lobes). Where the context is
    /// cancelled, some are not set.
    void set_rows(const CodedRows& rows, const Context& context = {});

    /// Toward y, the first node of an area of at most `footprint` [m^2]; 0: the scatterer in whose
    /// cell y is. formats::kNone where that side of the material has no scatterer.
    std::uint32_t find(glm::vec3 y, const SurfaceSide& side, float footprint) const;

    /// Calls visit(node, weight, offset) for nodes of that side under a Gaussian around the
    /// footprint, of its second moments (1/12 in the square of its widths), out to three standard
    /// deviations. Nodes have radii of at most the narrow width of the footprint, or
    /// scatterers. `weight`: scatterers times the Gaussian; may call nothing.
    template <class Visit>
    void find_near(const FootprintKernel& kernel, const SurfaceSide& side, Brightness looked_for,
                   Visit&& visit) const;
    /// The node of the sky in a direction, whose row is what a surface of its radiance sends out:
    /// pi times the mean over its texel. formats::kNone where rows are no cube maps.
    std::uint32_t sky_node(glm::vec3 direction) const;
    /// The node whose row is the irradiance of the scatterer of a leaf; formats::kNone where that
    /// has none: only those with narrow lobes do.
    std::uint32_t irradiance_node(std::uint32_t leaf) const {
        return lobes_.irradiance.empty() ? formats::kNone : lobes_.irradiance[leaf];
    }
    /// What narrow lobes mirror on average of even light at the scatterers of a node, in the
    /// largest band: no part of its row.
    float mirrored(std::uint32_t node) const {
        return node < lobes_.mirrored.size() ? lobes_.mirrored[node] : 0;
    }
    bool has_lobes() const { return !lobes_.mirrored.empty(); }
    /// Whether a node is a texel of the sky.
    bool is_sky(std::uint32_t node) const;
    /// Adds the row of such a node, times a weight, to a plane of it that is still in texels.
    void add_sky(std::uint32_t node, float weight, std::span<float> texels) const;
    /// Solid angle [sr] of the texel of a node of the sky; of other nodes infinity.
    float solid_angle_of_sky(std::uint32_t node) const;
    /// Of each scatterer, the area of its part of the surface [m^2].
    std::vector<float> cells() const;
    /// Of a node that find() returns for a footprint of 0.
    std::uint32_t scatterer_of(std::uint32_t node) const { return extents_[node].scatterer; }
    /// Nodes of one scatterer each, and where it is [m].
    std::vector<std::uint32_t> leaves() const;
    /// Of nodes below size(): its first child follows it; the second one, 0 of a leaf.
    std::uint32_t second_child(std::uint32_t node) const { return nodes_[node].right; }
    glm::vec3 centre(std::uint32_t node) const { return nodes_[node].centre; }
    /// All scatterers, such that neighbours in space are mostly neighbours in the list.
    std::vector<std::uint32_t> neighbours() const;
    /// Of a scatterer's node, of its openness; of others between those of the ends.
    Brightness brightness(std::uint32_t node) const { return nodes_[node].middle; }

    /// Rows of nodes.
    const CodedRows& rows() const { return rows_; }
    std::size_t size() const { return nodes_.size(); }
    std::size_t row_size() const { return row_size_; }

  private:
    // What every look-up reads of a node, half a line of the cache.
    struct Node {
        glm::vec3 centre{0};  // [m], mean of its scatterers'
        float radius = 0;     // [m], of the farthest
        float split = 0;      // [m]
        float cell = 0;       // [m^2], of its scatterers
        Brightness middle{};  // of the mean of its darkest and brightest scatterer
        // Second child, the first follows the node; 0: a leaf. Its axis of the split; whether its
        // scatterers differ too much in openness for a mean of them.
        std::uint32_t right : 29 = 0, axis : 2 = 0, is_mixed : 1 = 0;
    };
    static_assert(sizeof(Node) == 32);
    struct Extent {
        float area = 0;               // [m^2], of the bounding box's largest side
        std::uint32_t scatterer = 0;  // of a leaf
    };
    struct Box {
        glm::vec3 low, high;
    };
    float build(std::span<const Scatterer> scatterers, std::span<std::uint32_t> members,
                const Box& cell, std::uint32_t depth);
    std::uint32_t root_of(const SurfaceSide& side) const;
    // Appends rows of the sky, in the order of its texels.
    void set_sky();
    // Appends nodes of irradiance.
    void set_lobes(std::span<const Scatterer> scatterers);
    // Rows of a node and all below it, one after the other; returns its own.
    std::vector<float> set_branch(const CodedRows& rows, Range nodes);
    // second becomes the node's mean of both its children.
    void average(std::size_t node, std::span<const float> first, std::span<float> second) const;

    std::vector<Node> nodes_;
    std::vector<Extent> extents_;          // of nodes
    std::vector<std::uint32_t> roots_;     // by material, side and axis
    std::vector<float> sky_solid_angles_;  // [sr], of the texels of a face
    struct Lobes {
        std::vector<float> mirrored;            // of nodes; empty: no scatterer has any
        std::vector<std::uint32_t> irradiance;  // node of each leaf
        std::size_t scatterers = 0, count = 0;  // all; those with lobes
    } lobes_;
    CodedRows rows_;
    std::size_t row_size_;
};

template <class Visit>
void BounceTree::find_near(const FootprintKernel& kernel, const SurfaceSide& side,
                           Brightness looked_for, Visit&& visit) const {
    const std::uint32_t root = root_of(side);
    if (root == formats::kNone) return;
    constexpr float kReach = 0.8660254f;  // 3 / sqrt(12)
    constexpr float kWidest = 1;
    const glm::vec3 low = kernel.centre - kReach * kernel.extent;
    const glm::vec3 high = kernel.centre + kReach * kernel.extent;
    const glm::vec3 slope{glm::length(kernel.across), glm::length(kernel.along),
                          glm::length(kernel.above)};
    std::array<std::uint32_t, kMostWaiting> waiting;
    waiting[0] = root;
    std::size_t count = 1;
    while (count > 0) {
        const std::uint32_t v = waiting[--count];
        const Node& node = nodes_[v];
        const glm::vec3 offset = node.centre - kernel.centre;
        const glm::vec3 d{glm::dot(offset, kernel.across), glm::dot(offset, kernel.along),
                          glm::dot(offset, kernel.above)};
        const float square = glm::dot(d, d), radius = node.radius * kernel.steepest;
        const glm::vec3 nearest = glm::abs(d) - node.radius * slope;
        if (square > (kReach + radius) * (kReach + radius) ||
            std::max({nearest.x, nearest.y, nearest.z}) > kReach) {
            continue;
        }
        if (node.right != 0 && (radius > kWidest || node.is_mixed != 0)) {
            const auto axis = static_cast<glm::length_t>(node.axis);
            if (high[axis] >= node.split) {
                waiting[count++] = node.right;
            }
            if (low[axis] <= node.split) {
                waiting[count++] = v + 1;
            }
        } else if (square < kReach * kReach) {
            const float like = similarity(looked_for, node.middle);
            if (like > 0) {
                visit(v, like * node.cell * std::exp(-6 * square), glm::vec2(d));
            }
        }
    }
}

}  // namespace opaline::bake
