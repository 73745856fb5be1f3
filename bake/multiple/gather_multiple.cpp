#include "bake/multiple/gather_multiple.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNearSpacings = 6;  // radius of the near field in sample spacings

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
    const MediumProfile& profile;
    glm::vec3 position;
    std::array<float, 3> allowed;  // tolerance R ||E|| per band
    float near_squared;            // radius of the near field, 0 if there is none
    std::vector<ClusterWeight>& weights;
    std::vector<std::uint32_t> near;  // samples

    bool may_take(std::size_t v, const ClusterNode& node) const {
        const BoxDistance d = box_distance(node, position);
        if (d.nearest <= near_squared) {
            return false;
        }
        const std::array<float, 3> most = eval_profile(profile, d.nearest);
        const std::array<float, 3> least = eval_profile(profile, d.farthest);
        const float norm = tree.sums.norm[v];
        return norm * (most[0] - least[0]) <= allowed[0] &&
               norm * (most[1] - least[1]) <= allowed[1] &&
               norm * (most[2] - least[2]) <= allowed[2];
    }

    void visit() {
        std::array<std::uint32_t, 64> stack;  // median splits: depth below 32
        std::size_t height = 0;
        stack[height++] = 0;
        const auto node_count = static_cast<std::uint32_t>(tree.nodes.size());
        while (height > 0) {
            const std::uint32_t v = stack[--height];
            const ClusterNode& node = tree.nodes[v];
            if (may_take(v, node)) {
                weights.push_back(
                    {v, eval_profile(profile, squared_distance(position, node.centre))});
            } else if (node.right != 0) {
                stack[height++] = node.right;
                stack[height++] = v + 1;
            } else {
                for (std::uint32_t s = node.first; s < node.first + node.count; ++s) {
                    const float r2 = squared_distance(position, tree.position[s]);
                    if (r2 <= near_squared) {
                        near.push_back(s);
                    } else {
                        weights.push_back({node_count + s, eval_profile(profile, r2)});
                    }
                }
            }
        }
    }

    // Near samples, with weights that add up to the profile's integral over the disc where the
    // surface is one, else capped by its mean over a sample's own disc.
    void add_near(glm::vec3 normal, double spacing) {
        const double radius = std::sqrt(static_cast<double>(near_squared));
        double area = 0, facing = 0;
        std::array<double, 3> sum{};
        const std::size_t first = weights.size();
        for (const std::uint32_t s : near) {
            const auto a = static_cast<double>(tree.area[s]);
            area += a;
            facing += a * static_cast<double>(std::max(0.0f, glm::dot(normal, tree.normal[s])));
            ClusterWeight w{static_cast<std::uint32_t>(tree.nodes.size()) + s,
                            eval_profile(profile, squared_distance(position, tree.position[s]))};
            for (std::size_t band = 0; band < 3; ++band) {
                sum[band] += a * static_cast<double>(w.weight[band]);
            }
            weights.push_back(w);
        }
        const double share = area / (kPi * radius * radius);
        const bool is_disc = share > 0.8 && share < 1.3 && facing > 0.8 * area;
        for (std::size_t band = 0; band < 3; ++band) {
            if (spacing <= profile.dipole[band].z_real || sum[band] == 0) {
                continue;  // the plain sum is better than one per cent
            }
            if (is_disc) {
                const double scale = (profile.total(band) - profile.tail(band, radius)) / sum[band];
                for (std::size_t i = first; i < weights.size(); ++i) {
                    weights[i].weight[band] *= static_cast<float>(scale);
                }
                continue;
            }
            const double own = spacing / std::sqrt(kPi);
            const auto cap = static_cast<float>((profile.total(band) - profile.tail(band, own)) /
                                                (kPi * own * own));
            for (std::size_t i = first; i < weights.size(); ++i) {
                weights[i].weight[band] = std::min(weights[i].weight[band], cap);
            }
        }
    }
};

}  // namespace

void collect_weights(const ClusterTree& tree, const MediumProfile& profile, glm::vec3 position,
                     glm::vec3 normal, const GatherOptions& options,
                     std::vector<ClusterWeight>& weights) {
    weights.clear();
    if (tree.nodes.empty() || profile.table.empty()) {
        return;
    }
    const double spacing = std::sqrt(tree.total_area / static_cast<double>(tree.position.size()));
    Gather gather{tree, profile, position, {}, 0, weights, {}};
    for (std::size_t band = 0; band < 3; ++band) {
        // A negative allowance for nothing: no node is taken whole, whatever its sum.
        gather.allowed[band] =
            options.tolerance > 0
                ? static_cast<float>(options.tolerance * profile.total(band) * tree.mean_norm)
                : -1.0f;
    }
    const bool is_coarse = spacing > profile.smallest_z;
    if (is_coarse) {
        gather.near_squared = static_cast<float>(std::pow(kNearSpacings * spacing, 2));
    }
    gather.visit();
    if (!gather.near.empty()) {
        gather.add_near(normal, spacing);
    }
}

void accumulate(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                std::span<float> rgbx) {
    std::fill(rgbx.begin(), rgbx.end(), 0.0f);
    const std::size_t nodes = tree.nodes.size();
    for (const ClusterWeight& w : weights) {
        const SparseVectors& vectors = w.id < nodes ? tree.sums : tree.samples;
        const std::size_t v = w.id < nodes ? w.id : w.id - nodes;
        const float r = w.weight[0], g = w.weight[1], b = w.weight[2];
        for (std::uint64_t i = vectors.offset[v]; i < vectors.offset[v + 1]; ++i) {
            float* const sum = &rgbx[std::size_t{4} * vectors.index[i]];
            const float value = vectors.value[i];
            sum[0] += r * value;
            sum[1] += g * value;
            sum[2] += b * value;
        }
    }
}

}  // namespace opaline::bake
