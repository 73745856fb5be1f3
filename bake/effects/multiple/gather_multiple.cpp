#include "bake/effects/multiple/gather_multiple.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace opaline::bake {
namespace {

using Float4 = float __attribute__((vector_size(16)));

// Lower bound, so that the mean stays defined where all nearby samples face another way.
constexpr float kLeastFacing = 1e-3f;

float squared_distance(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 d = a - b;
    return glm::dot(d, d);
}

struct BoxDistance {
    float nearest, farthest;  // squared
};

BoxDistance box_distance(const ClusterNode& node, glm::vec3 x) {
    const glm::vec3 outside = glm::max(glm::vec3(0), glm::max(node.low - x, x - node.high));
    const glm::vec3 across = glm::max(glm::abs(x - node.low), glm::abs(x - node.high));
    return {glm::dot(outside, outside), glm::dot(across, across)};
}

struct Gather {
    const ClusterTree& tree;
    const GatherProfile& profile;
    glm::vec3 position;
    std::array<float, 3> allowed;  // tolerance R ||E|| per band
    float near_squared;            // radius of the near part, 0 if there is none
    std::vector<ClusterWeight>& weights;
    std::vector<std::size_t> near;  // indices into `weights`

    bool may_take(const ClusterNode& node) const {
        const BoxDistance d = box_distance(node, position);
        if (d.nearest < near_squared) return false;
        const std::array<float, 3> most = eval_far(profile, d.nearest);
        const std::array<float, 3> least = eval_far(profile, d.farthest);
        return node.norm * (most[0] - least[0]) <= allowed[0] &&
               (profile.bands == 1 || (node.norm * (most[1] - least[1]) <= allowed[1] &&
                                       node.norm * (most[2] - least[2]) <= allowed[2]));
    }

    // Light does not cross air by diffusion: samples of the point's own body count, where it has
    // any.
    void visit() {
        const std::uint32_t body = tree.bodies.body_at(position);
        if (tree.roots.empty()) {
            visit(0);
        } else if (tree.roots[body] != ClusterTree::kNoRoot) {
            visit(tree.roots[body]);
        } else {
            for (const std::uint32_t root : tree.roots) {
                if (root != ClusterTree::kNoRoot) visit(root);
            }
        }
    }

    void visit(std::uint32_t root) {
        std::array<std::uint32_t, 64> stack;  // median splits: depth below 32
        std::size_t height = 0;
        stack[height++] = root;
        const auto node_count = static_cast<std::uint32_t>(tree.nodes.size());
        while (height > 0) {
            const std::uint32_t v = stack[--height];
            const ClusterNode& node = tree.nodes[v];
            if (may_take(node)) {
                weights.push_back({v, eval_far(profile, squared_distance(position, node.centre))});
            } else if (node.right != 0) {
                stack[height++] = node.right;
                stack[height++] = v + 1;
            } else {
                for (std::uint32_t s = node.first; s < node.first + node.count; ++s) {
                    const float r2 = squared_distance(position, tree.position[s]);
                    if (r2 < near_squared) {
                        near.push_back(weights.size());
                    }
                    weights.push_back({node_count + s, eval_far(profile, r2)});
                }
            }
        }
    }

    // Adds the near part: the mean of E over nearby samples that face the same way. Weights fall
    // smoothly to zero at the radius, so that the result is continuous in the position.
    void add_near(glm::vec3 normal) {
        const std::size_t node_count = tree.nodes.size();
        std::vector<float> share(near.size());
        float sum = 0;
        for (std::size_t i = 0; i < near.size(); ++i) {
            const std::size_t s = weights[near[i]].id - node_count;
            const float inside = 1 - squared_distance(position, tree.position[s]) / near_squared;
            const float facing = std::max(kLeastFacing, glm::dot(normal, tree.normal[s]));
            share[i] = inside * inside * facing * facing;
            sum += share[i] * tree.area[s];
        }
        for (std::size_t i = 0; i < near.size() && sum > 0; ++i) {
            for (std::size_t band = 0; band < profile.bands; ++band) {
                weights[near[i]].weight[band] += profile.near_mass[band] * share[i] / sum;
            }
        }
    }
};

// The vector of a node, of which there are as many as sums, or a sample.
SparseVector entries_of(const SparseVectors& sums, const SparseVectors& samples,
                        const ClusterWeight& w) {
    return w.id < sums.size() ? sums[w.id] : samples[w.id - sums.size()];
}

// Adds weight * entries of other light, of one band or three.
void add_other(const ClusterTree& tree, std::span<const ClusterWeight> weights,
               std::span<float> rgbx) {
    const std::size_t bands = tree.other_samples.bands;
    for (const ClusterWeight& w : weights) {
        const SparseVector entries = entries_of(tree.other_sums, tree.other_samples, w);
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            float* const to = &rgbx[4 * std::size_t{entries.index[i]}];
            for (std::size_t b = 0; b < 3; ++b) {
                to[b] +=
                    tree.other_factor[b] * w.weight[b] * entries.value[bands == 1 ? i : 3 * i + b];
            }
        }
    }
}

void add_other_grey(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                    std::span<float> sums) {
    constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};
    const std::size_t bands = tree.other_samples.bands;
    for (const ClusterWeight& w : weights) {
        const SparseVector entries = entries_of(tree.other_sums, tree.other_samples, w);
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            for (std::size_t b = 0; b < bands; ++b) {
                const float share = tree.other_factor[0] * (bands == 1 ? 1 : kLuminance[b]);
                sums[entries.index[i]] += share * w.weight[0] * entries.value[bands * i + b];
            }
        }
    }
}

// Adds weight * entries to sums that are as wide as the weight: one band, or several at once.
template <class Weight>
void add_entries(const SparseVector& entries, Weight weight, float* sums) {
    constexpr std::size_t kWidth = std::is_same_v<Weight, Float4> ? 4 : 1;
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const place = sums + kWidth * entries.index[i];
        Weight sum;
        std::memcpy(&sum, place, sizeof sum);
        sum += weight * entries.value[i];
        std::memcpy(place, &sum, sizeof sum);
    }
}

}  // namespace

void collect_weights(const ClusterTree& tree, const GatherProfile& profile, glm::vec3 position,
                     glm::vec3 normal, const GatherOptions& options,
                     std::vector<ClusterWeight>& weights) {
    weights.clear();
    if (tree.nodes.empty() || profile.table.empty()) return;
    const float radius = profile.near_radius;
    Gather gather{tree, profile, position, {}, radius * radius, weights, {}};
    for (std::size_t band = 0; band < profile.bands; ++band) {
        // -1 disables clustering: no node meets a negative bound.
        gather.allowed[band] =
            options.tolerance > 0
                ? static_cast<float>(options.tolerance * profile.total[band] * tree.mean_norm)
                : -1.0f;
    }
    gather.visit();
    while (radius > 0 && gather.near.empty()) {
        // No sample lies within the radius, as on very small parts: widen it to the nearest
        // samples.
        gather.near_squared *= 4;
        weights.clear();
        gather.visit();
    }
    if (radius > 0) {
        gather.add_near(normal);
    }
}

void accumulate(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                std::span<float> rgbx) {
    std::fill(rgbx.begin(), rgbx.end(), 0.0f);
    for (const ClusterWeight& w : weights) {
        add_entries(entries_of(tree.sums, tree.samples, w),
                    Float4{w.weight[0], w.weight[1], w.weight[2], 0.0f}, rgbx.data());
    }
    if (tree.other_samples.size() > 0) {
        add_other(tree, weights, rgbx);
    }
}

void accumulate_grey(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                     std::span<float> sums) {
    std::fill(sums.begin(), sums.end(), 0.0f);
    for (const ClusterWeight& w : weights) {
        add_entries(entries_of(tree.sums, tree.samples, w), w.weight[0], sums.data());
    }
    if (tree.other_samples.size() > 0) {
        add_other_grey(tree, weights, sums);
    }
}

}  // namespace opaline::bake
