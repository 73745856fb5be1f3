#include "bake/refine/coarse_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace opaline::bake {
namespace {

using Corners = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNobody = 0xffffffffu;

// 3/2 of the kernel's integral.
double cosine_kernel(glm::vec3 a, glm::vec3 b) {
    const double cosine = std::clamp(glm::dot(glm::dvec3(a), glm::dvec3(b)), -1.0, 1.0);
    return std::sqrt(1 - cosine * cosine) + (std::numbers::pi - std::acos(cosine)) * cosine;
}

std::uint64_t edge_of(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

// Weights of the corners of a triangle at the point of its plane next to `x`; negative outside.
glm::vec3 weights_at(glm::vec3 x, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::dvec3 ab(b - a), ac(c - a), ax(x - a);
    const double bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac);
    const double xb = glm::dot(ax, ab), xc = glm::dot(ax, ac), area = bb * cc - bc * bc;
    if (!(area > 0)) return {-1, -1, -1};
    const double v = (cc * xb - bc * xc) / area, w = (bb * xc - bc * xb) / area;
    return {1 - v - w, v, w};
}

glm::vec3 inside_triangle(glm::vec3 weights) {
    weights = glm::max(weights, glm::vec3(0));
    return weights / (weights.x + weights.y + weights.z);
}

class Coarsener {
  public:
    Coarsener(const DenseMesh& mesh, const CoarseLimits& limits)
        : mesh_(mesh),
          limits_(limits),
          triangle_(mesh.triangle),
          ring_(mesh.position.size()),
          stays_(mesh.position.size(), false),
          home_(mesh.position.size(), kNobody),
          taken_(mesh.triangle.size()) {
        for (std::uint32_t t = 0; t < triangle_.size(); ++t) {
            for (const std::uint32_t v : triangle_[t]) {
                ring_[v].push_back(t);
            }
        }
        hold_borders();
    }

    std::vector<CoarseMix> run() {
        std::vector<std::uint32_t> open;
        for (std::uint32_t v = 0; v < ring_.size(); ++v) {
            if (!stays_[v]) open.push_back(v);
        }
        std::vector<std::uint32_t> touched(ring_.size(), 0);
        for (std::uint32_t pass = 1; !open.empty(); ++pass) {
            sort_by_edges(open);
            std::vector<std::uint32_t> later;
            for (const std::uint32_t v : open) {
                if (home_[v] != kNobody) continue;
                if (touched[v] == pass) {
                    later.push_back(v);
                    continue;
                }
                const std::vector<std::uint32_t> around = neighbours(v);
                if (!take_away(v, around)) continue;
                // Another look at neighbours, none of which goes in the same pass: vertices that
                // stay lie evenly.
                for (const std::uint32_t u : around) {
                    if (touched[u] != pass && !stays_[u]) later.push_back(u);
                    touched[u] = pass;
                }
            }
            std::ranges::sort(later);
            later.erase(std::unique(later.begin(), later.end()), later.end());
            open = std::move(later);
        }
        return mixes();
    }

  private:
    // Where a vertex that was taken away lies after a collapse.
    struct Move {
        std::uint32_t vertex, triangle;
    };

    void hold_borders() {
        std::vector<std::uint64_t> edges;
        for (const Corners& t : triangle_) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                edges.push_back(edge_of(t[k], t[(k + 1) % 3]));
            }
        }
        std::ranges::sort(edges);
        for (std::size_t i = 0; i < edges.size();) {
            const std::size_t begin = i;
            while (i < edges.size() && edges[i] == edges[begin])
                ++i;
            if (i - begin == 2) continue;
            stays_[static_cast<std::uint32_t>(edges[begin] >> 32)] = true;
            stays_[static_cast<std::uint32_t>(edges[begin])] = true;
        }
        for (std::uint32_t v = 0; v < ring_.size(); ++v) {
            if (ring_[v].size() < 3 || mesh_.normal[v] == glm::vec3(0) || !is_one_fan(v)) {
                stays_[v] = true;
            }
        }
    }

    // Two fans that touch in one vertex are no disc.
    bool is_one_fan(std::uint32_t v) const { return neighbours(v).size() == ring_[v].size(); }

    std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
        std::vector<std::uint32_t> around;
        for (const std::uint32_t t : ring_[v]) {
            for (const std::uint32_t u : triangle_[t]) {
                if (u != v && std::ranges::find(around, u) == around.end()) around.push_back(u);
            }
        }
        return around;
    }

    float edge(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(mesh_.position[a], mesh_.position[b]);
    }

    void sort_by_edges(std::vector<std::uint32_t>& vertices) const {
        std::vector<std::pair<float, std::uint32_t>> order;
        for (const std::uint32_t v : vertices) {
            if (home_[v] != kNobody) continue;
            float shortest = std::numeric_limits<float>::infinity();
            for (const std::uint32_t t : ring_[v]) {
                for (const std::uint32_t u : triangle_[t]) {
                    if (u != v) shortest = std::min(shortest, edge(u, v));
                }
            }
            order.emplace_back(shortest, v);
        }
        std::ranges::sort(order);
        vertices.clear();
        for (const auto& [length, v] : order) {
            vertices.push_back(v);
        }
    }

    // Onto the neighbour that leaves the shortest edges, of those that the limits allow.
    bool take_away(std::uint32_t v, std::span<const std::uint32_t> around) {
        std::vector<std::pair<float, std::uint32_t>> onto;
        for (const std::uint32_t u : around) {
            float longest = 0;
            for (const std::uint32_t w : around) {
                longest = std::max(longest, edge(u, w));
            }
            onto.emplace_back(longest, u);
        }
        std::ranges::sort(onto);
        constexpr std::size_t kMostTried = 3;
        for (std::size_t i = 0; i < std::min(onto.size(), kMostTried); ++i) {
            if (collapse(v, onto[i].second)) return true;
        }
        return false;
    }

    bool collapse(std::uint32_t v, std::uint32_t u) {
        std::vector<std::uint32_t> kept;  // triangles, with u instead of v
        std::size_t gone = 0;
        for (const std::uint32_t t : ring_[v]) {
            if (std::ranges::find(triangle_[t], u) != triangle_[t].end()) {
                ++gone;
            } else {
                kept.push_back(t);
            }
        }
        if (gone != 2) return false;
        std::vector<Corners> made;
        for (const std::uint32_t t : kept) {
            made.push_back(triangle_[t]);
            std::ranges::replace(made.back(), v, u);
            if (!faces_as_before(triangle_[t], made.back())) return false;
        }
        std::vector<Move> moves;
        if (!stays_a_surface(v, u) || !settle(v, kept, made, moves)) return false;
        for (const std::uint32_t t : ring_[v]) {
            taken_[t].clear();
            for (const std::uint32_t corner : triangle_[t]) {
                if (corner != v) std::erase(ring_[corner], t);
            }
        }
        for (std::size_t i = 0; i < kept.size(); ++i) {
            triangle_[kept[i]] = made[i];
            for (const std::uint32_t corner : made[i]) {
                ring_[corner].push_back(kept[i]);
            }
        }
        ring_[v].clear();
        for (const Move& move : moves) {
            home_[move.vertex] = move.triangle;
            taken_[move.triangle].push_back(move.vertex);
        }
        return true;
    }

    // The link condition: neighbours of both are the two corners beside their edge.
    bool stays_a_surface(std::uint32_t v, std::uint32_t u) const {
        const std::vector<std::uint32_t> of_v = neighbours(v), of_u = neighbours(u);
        return std::ranges::count_if(of_v, [&](std::uint32_t w) {
                   return std::ranges::find(of_u, w) != of_u.end();
               }) == 2;
    }

    glm::vec3 area_normal(const Corners& t) const {
        const glm::vec3 a = mesh_.position[t[0]];
        return glm::cross(mesh_.position[t[1]] - a, mesh_.position[t[2]] - a);
    }

    bool faces_as_before(const Corners& before, const Corners& after) const {
        constexpr float kTurn = 0.5f, kNotFlat = 0.05f;
        const glm::vec3 a = area_normal(before), b = area_normal(after);
        const float length = glm::length(b);
        float longest = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            longest = std::max(longest, edge(after[k], after[(k + 1) % 3]));
            if (!(glm::dot(b, mesh_.normal[after[k]]) > 0)) return false;
        }
        return length > kNotFlat * longest * longest &&
               glm::dot(a, b) > kTurn * glm::length(a) * length;
    }

    // Finds a triangle for all that was taken away around v, and for v itself.
    bool settle(std::uint32_t v, std::span<const std::uint32_t> kept, std::span<const Corners> made,
                std::vector<Move>& moves) const {
        std::vector<float> longest;
        for (const Corners& t : made) {
            longest.push_back(std::max({edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])}));
        }
        const auto place = [&](std::uint32_t p) {
            float best = -std::numeric_limits<float>::infinity();
            std::size_t found = 0;
            for (std::size_t i = 0; i < made.size(); ++i) {
                const glm::vec3 w = weights_in(p, made[i]);
                const float inside = std::min({w.x, w.y, w.z});
                if (inside > best) {
                    best = inside;
                    found = i;
                }
            }
            constexpr float kOutside = -0.25f;
            if (best < kOutside || longest[found] > limits_.spacing[p]) return false;
            if (error_at(p, made[found]) > limits_.normal_error) return false;
            moves.push_back({p, kept[found]});
            return true;
        };
        if (!place(v)) return false;
        for (const std::uint32_t t : ring_[v]) {
            for (const std::uint32_t p : taken_[t]) {
                if (!place(p)) return false;
            }
        }
        return true;
    }

    glm::vec3 weights_in(std::uint32_t p, const Corners& t) const {
        return weights_at(mesh_.position[p], mesh_.position[t[0]], mesh_.position[t[1]],
                          mesh_.position[t[2]]);
    }

    double error_at(std::uint32_t p, const Corners& t) const {
        const glm::vec3 w = inside_triangle(weights_in(p, t));
        return normal_error(mesh_.normal[p],
                            {mesh_.normal[t[0]], mesh_.normal[t[1]], mesh_.normal[t[2]]},
                            {w.x, w.y, w.z});
    }

    std::vector<CoarseMix> mixes() const {
        std::vector<CoarseMix> mixes(ring_.size());
        for (std::uint32_t v = 0; v < mixes.size(); ++v) {
            mixes[v].vertex.fill(v);
            if (home_[v] == kNobody) continue;
            const Corners& t = triangle_[home_[v]];
            const glm::vec3 w = inside_triangle(weights_in(v, t));
            std::array<std::pair<float, std::uint32_t>, 3> sorted{
                std::pair{w.x, t[0]}, {w.y, t[1]}, {w.z, t[2]}};
            std::ranges::stable_sort(sorted, std::greater<>(),
                                     [](const auto& s) { return s.first; });
            for (std::size_t k = 0; k < 3; ++k) {
                mixes[v].weight[k] = sorted[k].first;
                mixes[v].vertex[k] = sorted[k].second;
            }
        }
        return mixes;
    }

    const DenseMesh& mesh_;
    const CoarseLimits& limits_;
    std::vector<Corners> triangle_;
    std::vector<std::vector<std::uint32_t>> ring_;  // triangles of each vertex; none: taken away
    std::vector<bool> stays_;
    std::vector<std::uint32_t> home_;                // triangle of each vertex that was taken away
    std::vector<std::vector<std::uint32_t>> taken_;  // of each triangle, vertices that lie in it
};

}  // namespace

double normal_error(glm::vec3 normal, const std::array<glm::vec3, 3>& normals,
                    const std::array<float, 3>& weights) {
    double sum = std::numbers::pi;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const auto wi = static_cast<double>(weights[i]);
        if (wi == 0) continue;
        sum += wi * wi * std::numbers::pi - 2 * wi * cosine_kernel(normal, normals[i]);
        for (std::size_t j = 0; j < i; ++j) {
            const auto wj = static_cast<double>(weights[j]);
            if (wj != 0) sum += 2 * wi * wj * cosine_kernel(normals[i], normals[j]);
        }
    }
    return std::max(0.0, sum) / std::numbers::pi;
}

std::vector<CoarseMix> coarsen(const DenseMesh& mesh, const CoarseLimits& limits) {
    return Coarsener(mesh, limits).run();
}

}  // namespace opaline::bake
