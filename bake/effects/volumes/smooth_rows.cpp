#include "bake/effects/volumes/smooth_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/attenuation.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

// By number of axes along which a neighbour is another: edges, faces, cells.
constexpr std::size_t kKinds = 4;

struct Offset {
    glm::ivec3 step{0};
    std::size_t kind = 0;
};

// One of each two opposite ones.
constexpr std::array<Offset, NodePairs::kCount> kOffsets{{{{1, 0, 0}, 1},
                                                          {{0, 1, 0}, 1},
                                                          {{0, 0, 1}, 1},
                                                          {{1, 1, 0}, 2},
                                                          {{1, -1, 0}, 2},
                                                          {{1, 0, 1}, 2},
                                                          {{1, 0, -1}, 2},
                                                          {{0, 1, 1}, 2},
                                                          {{0, 1, -1}, 2},
                                                          {{1, 1, 1}, 3},
                                                          {{1, 1, -1}, 3},
                                                          {{1, -1, 1}, 3},
                                                          {{1, -1, -1}, 3}}};

std::uint64_t key_of(glm::ivec3 voxel) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    const auto part = [](int i) { return static_cast<std::uint64_t>(i) & kMask; };
    return part(voxel.x) << 42 | part(voxel.y) << 21 | part(voxel.z);
}

bool is_there(const std::array<std::uint32_t, 2>& pair) {
    return pair[0] != formats::kNoNode;
}

bool is_alike(float density, float own) {
    constexpr float kLeast = 0.75f;
    return density >= kLeast * own && own >= kLeast * density;
}

std::size_t degree_of_row(std::size_t k) {
    return static_cast<std::size_t>(std::sqrt(static_cast<double>(k)));
}

constexpr std::array<float, 6> kTried{0, 0.0625f, 0.125f, 0.25f, 0.5f, 1};

constexpr float kBetweenNodes = 8.0f / 27;  // of noise

// Sums over a node, its neighbours along edges, across faces and across cells, and how many.
struct Sums {
    std::array<std::vector<float>, kKinds> value;
    std::array<float, kKinds> count{};

    float mean(float weight, std::size_t i) const {
        float sum = 0, all = 0, power = 1;
        for (std::size_t kind = 0; kind < kKinds; ++kind, power *= weight) {
            sum += power * value[kind][i];
            all += power * count[kind];
        }
        return sum / all;
    }
};

template <class RowsOf>
Sums sum_neighbours(const NodePairs& pairs, std::size_t node, const RowsOf& rows_of) {
    Sums sums;
    const std::vector<float>& own = rows_of(node);
    sums.value.fill(std::vector<float>(own.size(), 0.0f));
    sums.value[0] = own;
    sums.count[0] = 1;
    for (std::size_t p = 0; p < pairs.node.size(); ++p) {
        if (!is_there(pairs.node[p])) continue;
        std::vector<float>& to = sums.value[kOffsets[p].kind];
        for (const std::uint32_t other : pairs.node[p]) {
            const std::vector<float>& from = rows_of(other);
            for (std::size_t i = 0; i < to.size(); ++i) {
                to[i] += from[i];
            }
            ++sums.count[kOffsets[p].kind];
        }
    }
    return sums;
}

// Sums over nodes, of rows smoothed with one weight.
struct TriedSums {
    double error = 0, noise = 0, light = 0;  // squares
};
using TriedErrors = std::array<std::array<TriedSums, kTried.size()>, SmoothingWeights().size()>;

void add_errors(std::span<const WalkedNode> nodes, const NodePairs& pairs, std::size_t node,
                double density, std::uint32_t terms, TriedErrors& errors) {
    std::array<Sums, 2> half;
    for (std::size_t h = 0; h < 2; ++h) {
        half[h] = sum_neighbours(pairs, node, [&](std::size_t i) -> const std::vector<float>& {
            return nodes[i].half[h];
        });
    }
    const std::vector<float>&a = nodes[node].half[0], &b = nodes[node].half[1];
    const std::size_t row = a.size() / terms;
    for (std::size_t i = 0; i < a.size(); ++i) {
        auto& of_degree = errors[degree_of_row(i / row)];
        for (std::size_t t = 0; t < kTried.size(); ++t) {
            const float sa = half[0].mean(kTried[t], i), sb = half[1].mean(kTried[t], i);
            const float noise = (sa - sb) * (sa - sb) / 4;
            const float apart = ((sa - b[i]) * (sa - b[i]) + (sb - a[i]) * (sb - a[i])) / 2;
            of_degree[t].error +=
                density * static_cast<double>(apart - (2 - kBetweenNodes) * noise);
            of_degree[t].noise += density * static_cast<double>(noise);
            of_degree[t].light += density * static_cast<double>(sa * sb);
        }
    }
}

}  // namespace

std::vector<float> reduce_rows(std::span<const float> rows, std::size_t planes, std::uint32_t n) {
    const std::uint32_t m = std::min(n, 2u);
    const std::size_t cells = formats::cubemap_texels(n);
    std::vector<float> reduced;
    for (std::size_t plane = 0; plane < planes; ++plane) {
        const auto own = rows.subspan(plane * cells, cells);
        const std::vector<float> means =
            reduce_cells(std::vector<float>(own.begin(), own.end()), n, m);
        reduced.insert(reduced.end(), means.begin(), means.end());
    }
    return reduced;
}

std::vector<NodePairs> find_node_pairs(const NodeLattice& lattice, std::span<const float> density,
                                       const glm::dmat4& to_scene, const RayScene& rays) {
    std::unordered_map<std::uint64_t, std::uint32_t> number;
    for (std::uint32_t i = 0; i < lattice.node.size(); ++i) {
        number.emplace(key_of(lattice.node[i]), i);
    }
    std::uint64_t traced = 0;
    const auto is_open = [&](glm::ivec3 from, glm::ivec3 to) {
        const glm::vec3 start(to_scene * glm::dvec4(glm::dvec3(from), 1));
        const glm::vec3 way = glm::vec3(to_scene * glm::dvec4(glm::dvec3(to - from), 0));
        const float length = glm::length(way);
        return find_surface(rays, start, way / length, traced).distance > length;
    };
    std::vector<NodePairs> pairs(lattice.node.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const glm::ivec3 own = lattice.node[i];
        for (std::size_t p = 0; p < kOffsets.size(); ++p) {
            const glm::ivec3 step = kOffsets[p].step * static_cast<int>(lattice.spacing);
            pairs[i].node[p].fill(formats::kNoNode);
            const auto after = number.find(key_of(own + step)),
                       before = number.find(key_of(own - step));
            if (after == number.end() || before == number.end()) continue;
            const std::array<std::uint32_t, 2> pair{after->second, before->second};
            if (is_alike(density[pair[0]], density[i]) && is_alike(density[pair[1]], density[i]) &&
                is_open(own, own + step) && is_open(own, own - step)) {
                pairs[i].node[p] = pair;
            }
        }
    }
    return pairs;
}

Smoothing choose_smoothing(std::span<const WalkedNode> nodes, std::span<const NodePairs> pairs,
                           std::span<const float> density, std::uint32_t terms,
                           const Context& context) {
    constexpr std::size_t kAtOnce = 64;
    TriedErrors all{};
    for_each_block_in_order(
        nodes.size(), kAtOnce, context,
        [&](Range range) {
            TriedErrors errors{};
            for (std::size_t i = range.begin; i < range.end; ++i) {
                add_errors(nodes, pairs[i], i, static_cast<double>(density[i]), terms, errors);
            }
            return errors;
        },
        [&](Range, TriedErrors&& errors) {
            for (std::size_t l = 0; l < all.size(); ++l) {
                for (std::size_t t = 0; t < kTried.size(); ++t) {
                    all[l][t].error += errors[l][t].error;
                    all[l][t].noise += errors[l][t].noise;
                    all[l][t].light += errors[l][t].light;
                }
            }
        });
    Smoothing smoothing;
    double noise = 0, light = 0;
    for (std::size_t l = 0; l < all.size(); ++l) {
        const auto best = std::ranges::min_element(all[l], {}, &TriedSums::error) - all[l].begin();
        smoothing.weights[l] = kTried[static_cast<std::size_t>(best)];
        noise += all[l][static_cast<std::size_t>(best)].noise;
        light += all[l][static_cast<std::size_t>(best)].light;
    }
    smoothing.noise = light > 0 ? std::sqrt(noise / light) : 0;
    return smoothing;
}

std::vector<float> smooth_rows(std::span<const WalkedNode> nodes, std::span<const NodePairs> pairs,
                               std::size_t node, const SmoothingWeights& weights,
                               std::uint32_t terms) {
    if (weights == SmoothingWeights{}) return nodes[node].rows;
    const Sums sums =
        sum_neighbours(pairs[node], node,
                       [&](std::size_t i) -> const std::vector<float>& { return nodes[i].rows; });
    std::vector<float> rows = nodes[node].rows;
    const std::size_t row = rows.size() / terms;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = sums.mean(weights[degree_of_row(i / row)], i);
    }
    return rows;
}

}  // namespace opaline::bake
