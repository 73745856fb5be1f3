#include "bake/multiple/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bake/base/ordered_parallel.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSamplesPerLeaf = 8;

struct Builder {
    std::span<const SurfaceSample> samples;
    const SampleTransport& transport;
    ClusterTree& tree;

    ClusterNode bound(std::uint32_t first, std::uint32_t count) const {
        ClusterNode node{samples[tree.order[first]].position,
                         samples[tree.order[first]].position,
                         {},
                         first,
                         count,
                         0};
        glm::dvec3 by_light(0), by_area(0);
        double light = 0, area = 0;
        for (std::uint32_t i = first; i < first + count; ++i) {
            const SurfaceSample& sample = samples[tree.order[i]];
            node.low = glm::min(node.low, sample.position);
            node.high = glm::max(node.high, sample.position);
            const auto a = static_cast<double>(sample.area);
            const double w = a * static_cast<double>(transport.mean[tree.order[i]]);
            by_area += a * glm::dvec3(sample.position);
            by_light += w * glm::dvec3(sample.position);
            area += a;
            light += w;
        }
        node.centre = glm::vec3(light > 0 ? by_light / light : by_area / area);
        return node;
    }

    void build(std::uint32_t first, std::uint32_t count) {
        const std::size_t self = tree.nodes.size();
        tree.nodes.push_back(bound(first, count));
        if (count <= kSamplesPerLeaf) {
            return;
        }
        const glm::vec3 size = tree.nodes[self].high - tree.nodes[self].low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t half = count / 2;
        const auto begin = tree.order.begin() + first;
        std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
            const float x = samples[a].position[axis], y = samples[b].position[axis];
            return x != y ? x < y : a < b;
        });
        build(first, half);
        tree.nodes[self].right = static_cast<std::uint32_t>(tree.nodes.size());
        build(first + half, count - half);
    }
};

// The samples in the order of the tree, times their areas.
void copy_samples(std::span<const SurfaceSample> samples, const SampleTransport& transport,
                  const Context& context, ClusterTree& tree) {
    const SparseVectors& from = transport.rows;
    double squares = 0;
    for (const std::uint32_t s : tree.order) {
        const float area = samples[s].area;
        tree.position.push_back(samples[s].position);
        tree.normal.push_back(samples[s].geometric_normal);
        tree.area.push_back(area);
        tree.total_area += static_cast<double>(area);
        tree.samples.offset.push_back(tree.samples.offset.back() + from.offset[s + 1] -
                                      from.offset[s]);
        tree.samples.norm.push_back(area * from.norm[s]);
        const auto norm = static_cast<double>(from.norm[s]);
        squares += static_cast<double>(area) * norm * norm;
    }
    tree.mean_norm = std::sqrt(squares / tree.total_area);
    tree.samples.index.resize(from.index.size());
    tree.samples.value.resize(from.value.size());
    for_each_block_in_order(
        tree.order.size(), 256, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const std::uint32_t s = tree.order[i];
                const float area = samples[s].area;
                std::uint64_t to = tree.samples.offset[i];
                for (std::uint64_t k = from.offset[s]; k < from.offset[s + 1]; ++k, ++to) {
                    tree.samples.index[to] = from.index[k];
                    tree.samples.value[to] = area * from.value[k];
                }
            }
            return range.end;
        },
        [](Range, std::size_t) {});
}

}  // namespace

ClusterTree build_cluster_tree(std::span<const SurfaceSample> samples,
                               const SampleTransport& transport, std::uint32_t cubemap_size,
                               std::uint32_t kept, const Context& context) {
    ClusterTree tree;
    if (samples.empty()) {
        return tree;
    }
    tree.order.resize(samples.size());
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    Builder{samples, transport, tree}.build(0, static_cast<std::uint32_t>(samples.size()));
    copy_samples(samples, transport, context, tree);
    for_each_block_in_order(
        tree.nodes.size(), 64, context,
        [&](Range range) {
            SparseVectors sums;
            reserve(sums, (range.end - range.begin) *
                              std::min<std::size_t>(kept, formats::cubemap_texels(cubemap_size)));
            std::vector<float> dense(formats::cubemap_texels(cubemap_size));
            for (std::size_t v = range.begin; v < range.end; ++v) {
                const ClusterNode& node = tree.nodes[v];
                std::fill(dense.begin(), dense.end(), 0.0f);
                const std::uint64_t end = tree.samples.offset[node.first + node.count];
                for (std::uint64_t i = tree.samples.offset[node.first]; i < end; ++i) {
                    dense[tree.samples.index[i]] += tree.samples.value[i];
                }
                append_truncated(sums, dense, kept);
            }
            return sums;
        },
        [&](Range, const SparseVectors& sums) { append_vectors(tree.sums, sums); });
    return tree;
}

}  // namespace opaline::bake
