#include "bake/effects/multiple/gather_multiple.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <type_traits>

#include "bake/effects/multiple/walks/limit_views.h"
#include "bake/effects/multiple/walks/view_fit.h"

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

// The constant stands in the first row even where more harmonics follow it.
std::uint32_t term_of(std::uint32_t harmonic, const RowLayout& layout) {
    return harmonic == 0 ? 0 : layout.first_harmonic() + harmonic;
}

// By how much a row by view counts in a harmonic.
class ViewFactors {
  public:
    ViewFactors(const ViewFit& fit, const ViewLimit& limit, glm::vec3 normal)
        : matrix_(to_harmonics(fit, normal)), limit_(limit) {}
    float operator()(std::uint32_t harmonic, std::uint32_t row) const {
        return (row < kFirstDegree ? limit_.first : limit_.second) * matrix_[harmonic][row];
    }

  private:
    ViewMatrix matrix_;
    ViewLimit limit_;
};

// Adds factor * sums, four floats per texel (one with one band), to a row of `to`.
void add_sums(std::span<const float> sums, float factor, std::uint32_t row, const DenseRow& to) {
    const std::size_t step = to.bands == 1 ? 1 : 4;
    for (std::uint32_t band = 0; band < to.bands; ++band) {
        const std::span<float> plane = to.plane(row, band);
        for (std::size_t k = 0; k < plane.size(); ++k) {
            plane[k] += factor * sums[step * k + band];
        }
    }
}

// `rows` by view as harmonics of the view w'. `sums`: T_d / scale.
void add_views(const ViewFit& fit, glm::vec3 normal, std::span<const float> sums,
               std::span<const float> rows, float scale, const RowLayout& layout,
               const DenseRow& row) {
    const ViewFactors factors(fit, limit_views(sums, rows, row.bands == 1 ? 1 : 4, normal, fit),
                              normal);
    for (std::uint32_t k = 0; k < layout.view_harmonics; ++k) {
        for (std::uint32_t r = 0; r + 1 < layout.view_harmonics; ++r) {
            const float factor = scale * factors(k, r);
            if (factor != 0) {
                add_sums(rows.subspan(r * sums.size(), sums.size()), factor, term_of(k, layout),
                         row);
            }
        }
    }
}

// What limit_views asks of rows: the average of each face.
std::vector<float> face_averages(const SiteRowSum& sum, std::uint32_t rows, const DenseRow& row) {
    constexpr std::size_t kFaces = 6;
    const std::size_t face = row.size() / kFaces, step = row.bands == 1 ? 1 : 4;
    std::vector<float> averages(rows * kFaces * step);
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::size_t f = 0; f < kFaces; ++f) {
            for (std::uint32_t band = 0; band < row.bands; ++band) {
                averages[(r * kFaces + f) * step + band] = sum.at(r, f * face, band);
            }
        }
    }
    return averages;
}

// From sites inside; a walked row is T_d / (pi c_exit).
void add_inner_rows(const WalkStage& walks, const BodyPoint& point, const RowLayout& layout,
                    const DenseRow& row) {
    const std::uint32_t rows = std::max(1u, layout.view_harmonics);
    const SiteRowSum sum = sum_inner_rows(walks, point, row.size(), rows);
    std::vector<SiteRowSum::Share> shares(rows);
    shares[0].of_row[0] = static_cast<float>(1 / layout.view_of_constant());
    if (rows > 1) {
        const std::vector<float> averages = face_averages(sum, rows, row);
        const std::span<const float> all(averages);
        const std::size_t one = averages.size() / rows;
        const ViewLimit limit = limit_views(all.first(one), all.subspan(one),
                                            row.bands == 1 ? 1 : 4, point.normal, walks.view_fit);
        const ViewFactors factors(walks.view_fit, limit, point.normal);
        for (std::uint32_t k = 0; k < rows; ++k) {
            shares[k].term = term_of(k, layout);
            for (std::uint32_t r = 0; r + 1 < rows; ++r) {
                shares[k].of_row[r + 1] = factors(k, r);
            }
        }
    }
    sum.add_to(shares, row);
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

void gather_dipole_row(const MultipleStage& stage, glm::vec3 position, glm::vec3 normal,
                       double tolerance, glm::vec3 factor, std::uint32_t bands,
                       std::span<float> rgbx) {
    std::vector<ClusterWeight> weights;
    collect_weights(stage.tree, stage.profile, position, normal, {tolerance}, weights);
    if (factor != glm::vec3(1)) {
        for (ClusterWeight& w : weights) {
            for (std::size_t b = 0; b < 3; ++b) {
                w.weight[b] *= factor[static_cast<int>(b)];
            }
        }
    }
    if (bands == 1) {
        accumulate_grey(stage.tree, weights, rgbx);
    } else {
        accumulate(stage.tree, weights, rgbx);
    }
}

void add_multiple_rows(const MultipleStage& stage, const BodyPoint& point, double tolerance,
                       const RowLayout& layout, const DenseRow& row) {
    if (!stage.walks.inner.empty() && !stage.walks.rows.blocks.empty()) {
        add_inner_rows(stage.walks, point, layout, row);
        return;
    }
    const double scale = 1 / (std::numbers::pi * stage.medium.exit);
    std::vector<float> sums((row.bands == 1 ? 1 : 4) * row.size());
    const std::uint32_t by_view = std::max(1u, layout.view_harmonics) - 1;
    std::vector<float> views(by_view * sums.size());
    if (!stage.tree.nodes.empty()) {
        gather_dipole_row(stage, point.position, point.normal, tolerance, glm::vec3(1), row.bands,
                          sums);
    }
    if (stage.model == MultipleModel::walks) {
        // A walked row is T_d / (pi c_exit).
        add_walked_rows(stage.walks, point,
                        static_cast<float>(std::numbers::pi * stage.medium.exit), sums, views);
    }
    add_sums(sums, static_cast<float>(scale / layout.view_of_constant()), 0, row);
    if (by_view > 0) {
        add_views(stage.walks.view_fit, point.normal, sums, views, static_cast<float>(scale),
                  layout, row);
    }
}

}  // namespace opaline::bake
