#include "bake/effects/multiple/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/kd_order.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

struct Builder {
    std::span<const SurfaceSample> samples;
    std::span<const float> mean;  // of E over the sphere
    std::vector<ClusterNode>& nodes;

    ClusterNode bound(std::uint32_t first, std::uint32_t count) const {
        ClusterNode node{samples[first].position, samples[first].position, {}, first, count, 0, 0};
        glm::dvec3 by_light(0), by_area(0);
        double light = 0, area = 0;
        for (std::uint32_t i = first; i < first + count; ++i) {
            const SurfaceSample& sample = samples[i];
            node.low = glm::min(node.low, sample.position);
            node.high = glm::max(node.high, sample.position);
            const auto a = static_cast<double>(sample.area);
            const double w = a * static_cast<double>(mean[i]);
            by_area += a * glm::dvec3(sample.position);
            by_light += w * glm::dvec3(sample.position);
            area += a;
            light += w;
        }
        node.centre = glm::vec3(light > 0 ? by_light / light : by_area / area);
        return node;
    }

    void build(std::uint32_t first, std::uint32_t count) {
        const std::size_t self = nodes.size();
        nodes.push_back(bound(first, count));
        if (count <= kSamplesPerLeaf) return;
        const std::uint32_t half = first_child_count(count);
        build(first, half);
        nodes[self].right = static_cast<std::uint32_t>(nodes.size());
        build(first + half, count - half);
    }
};

void copy_samples(std::span<const SurfaceSample> samples, std::span<const float> norms,
                  ClusterTree& tree) {
    double squares = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        tree.position.push_back(samples[i].position);
        tree.normal.push_back(samples[i].geometric_normal);
        tree.area.push_back(samples[i].area);
        const auto area = static_cast<double>(samples[i].area);
        const auto norm = static_cast<double>(norms[i]);
        tree.total_area += area;
        squares += area * norm * norm;
    }
    tree.mean_norm = std::sqrt(squares / tree.total_area);
}

// The sums over samples of each node, truncated; their norms add up to those of the nodes.
SparseVectors sum_nodes(const SparseVectors& samples, std::size_t texels, std::size_t kept,
                        const Context& context, std::vector<ClusterNode>& nodes) {
    SparseVectors sums;
    sums.bands = samples.bands;
    struct Part {
        SparseVectors::Block sums;
        std::vector<float> norm;
    };
    for_each_block_in_order(
        nodes.size(), SparseVectors::kPerBlock, context,
        [&](Range range) {
            Part part;
            reserve(part.sums, sums.bands * std::min(kept, texels));
            std::vector<float> dense(sums.bands * texels);
            for (std::size_t v = range.begin; v < range.end; ++v) {
                const ClusterNode& node = nodes[v];
                std::fill(dense.begin(), dense.end(), 0.0f);
                for (std::size_t s = node.first; s < node.first + node.count; ++s) {
                    const SparseVector sample = samples[s];
                    for (std::size_t i = 0; i < sample.index.size(); ++i) {
                        for (std::size_t b = 0; b < sums.bands; ++b) {
                            dense[b * texels + sample.index[i]] += sample.value[sums.bands * i + b];
                        }
                    }
                }
                part.norm.push_back(norm(dense));
                if (part.norm.back() > 0) {
                    append_truncated_bands(part.sums, dense, sums.bands, kept);
                } else {
                    append_nothing(part.sums);
                }
            }
            shrink(part.sums);
            return part;
        },
        [&](Range range, Part&& part) {
            sums.blocks.push_back(std::move(part.sums));
            for (std::size_t v = range.begin; v < range.end; ++v) {
                float& all = nodes[v].norm;
                const float own = part.norm[v - range.begin];
                all = all == 0 ? own : std::hypot(all, own);
            }
        });
    return sums;
}

}  // namespace

void sort_by_body(const SeparateBodies& bodies, std::vector<SurfaceSample>& samples) {
    if (bodies.count() <= 1) return;
    std::vector<std::vector<SurfaceSample>> of_body(bodies.count());
    for (const SurfaceSample& sample : samples) {
        of_body[bodies.body_at(sample.position)].push_back(sample);
    }
    samples.clear();
    for (std::vector<SurfaceSample>& own : of_body) {
        sort_into_groups(own);
        samples.insert(samples.end(), own.begin(), own.end());
    }
}

ClusterTree build_cluster_tree(std::span<const SurfaceSample> samples, SampleTransport transport,
                               std::uint32_t cubemap_size, std::uint32_t kept,
                               const Context& context, std::uint32_t kept_of_light,
                               SeparateBodies bodies) {
    ClusterTree tree;
    if (samples.empty()) return tree;
    Builder builder{samples, transport.mean, tree.nodes};
    if (bodies.count() <= 1) {
        builder.build(0, static_cast<std::uint32_t>(samples.size()));
    } else {
        tree.roots.assign(bodies.count(), ClusterTree::kNoRoot);
        for (std::uint32_t begin = 0, end = 0; begin < samples.size(); begin = end) {
            const std::uint32_t body = bodies.body_at(samples[begin].position);
            while (end < samples.size() && bodies.body_at(samples[end].position) == body)
                ++end;
            tree.roots[body] = static_cast<std::uint32_t>(tree.nodes.size());
            builder.build(begin, end - begin);
        }
    }
    tree.bodies = std::move(bodies);
    copy_samples(samples, transport.norm, tree);
    tree.samples = std::move(transport.rows);
    const std::size_t texels = formats::cubemap_texels(cubemap_size);
    tree.sums = sum_nodes(tree.samples, texels, kept, context, tree.nodes);
    tree.other_samples = std::move(transport.other);
    if (tree.other_samples.size() > 0) {
        tree.other_sums = sum_nodes(tree.other_samples, texels, kept_of_light, context, tree.nodes);
    }
    return tree;
}

}  // namespace opaline::bake
