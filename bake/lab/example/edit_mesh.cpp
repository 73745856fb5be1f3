#include "bake/lab/example/edit_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

namespace opaline::bake {
namespace {

constexpr int kPasses = 3;

double length_over_target(const TriangleMesh& mesh, const std::vector<double>& target,
                          std::uint32_t a, std::uint32_t b) {
    return glm::distance(mesh.position[a], mesh.position[b]) / (0.5 * (target[a] + target[b]));
}

/// An edge by its index in a list, and its length over its target.
struct RankedEdge {
    double length;
    std::size_t index;
    friend auto operator<=>(const RankedEdge&, const RankedEdge&) = default;
};

/// The edges whose relative length lies in (low, high), shortest first; ties by index, so that the
/// order is reproducible.
std::vector<RankedEdge> rank_edges(const TriangleMesh& mesh, const std::vector<double>& target,
                                   const std::vector<Edge>& edges, double low, double high) {
    std::vector<RankedEdge> rank;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double length = length_over_target(mesh, target, edges[i].a, edges[i].b);
        if (length > low && length < high) rank.push_back({length, i});
    }
    std::sort(rank.begin(), rank.end());
    return rank;
}

void replace_vertex(Triangle& triangle, std::uint32_t from, std::uint32_t to) {
    std::replace(triangle.begin(), triangle.end(), from, to);
}

/// The vertices joined to v by an edge, sorted.
std::vector<std::uint32_t> neighbours(const TriangleMesh& mesh, const VertexTriangles& ring,
                                      std::uint32_t v) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
        for (const std::uint32_t other : mesh.triangles[ring.triangle[i]]) {
            if (other != v) found.push_back(other);
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

/// True if moving `v` to `to` neither flips its triangles, except those that contain `other`, nor
/// makes slivers of them.
bool may_move(const TriangleMesh& mesh, const VertexTriangles& ring, std::uint32_t v,
              std::uint32_t other, const glm::dvec3& to) {
    for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
        const Triangle& t = mesh.triangles[ring.triangle[i]];
        if (std::find(t.begin(), t.end(), other) != t.end()) continue;
        std::array<glm::dvec3, 3> corner;
        for (std::size_t j = 0; j < 3; ++j) {
            corner[j] = t[j] == v ? to : mesh.position[t[j]];
        }
        const glm::dvec3 e0 = corner[1] - corner[0], e1 = corner[2] - corner[1],
                         e2 = corner[0] - corner[2];
        const glm::dvec3 before = area_vector(mesh, t), after = glm::cross(e0, e1);
        const double area = glm::length(after);
        if (glm::dot(before, after) < 0.6 * glm::length(before) * area) return false;
        const double longest = std::max({glm::dot(e0, e0), glm::dot(e1, e1), glm::dot(e2, e2)});
        if (area < 0.2 * longest) return false;
    }
    return true;
}

/// Drops triangles marked by equal corners and vertices that no triangle uses.
void compact(TriangleMesh& mesh, std::vector<double>& target) {
    std::erase_if(mesh.triangles,
                  [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renamed(mesh.position.size(), kUnused);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle) {
            renamed[v] = 0;
        }
    }
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < renamed.size(); ++v) {
        if (renamed[v] == kUnused) continue;
        renamed[v] = count;
        mesh.position[count] = mesh.position[v];
        mesh.normal[count] = mesh.normal[v];
        target[count] = target[v];
        ++count;
    }
    mesh.position.resize(count);
    mesh.normal.resize(count);
    target.resize(count);
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) {
            v = renamed[v];
        }
    }
}

}  // namespace

void split_long_edges(TriangleMesh& mesh, std::vector<double>& target) {
    for (int pass = 0; pass < kPasses; ++pass) {
        const std::vector<Edge> edges = find_edges(mesh);
        const auto rank = rank_edges(mesh, target, edges, 4.0 / 3.0, 1e9);
        if (rank.empty()) break;
        std::vector<bool> touched(mesh.triangles.size(), false);
        for (auto item = rank.rbegin(); item != rank.rend(); ++item) {
            const Edge& edge = edges[item->index];
            if (touched[edge.left] || touched[edge.right]) continue;
            touched[edge.left] = touched[edge.right] = true;
            const auto middle = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.push_back(0.5 * (mesh.position[edge.a] + mesh.position[edge.b]));
            mesh.normal.push_back(glm::normalize(mesh.normal[edge.a] + mesh.normal[edge.b] +
                                                 1e-6 * mesh.normal[edge.a]));
            target.push_back(0.5 * (target[edge.a] + target[edge.b]));
            for (const std::uint32_t t : {edge.left, edge.right}) {
                Triangle half = mesh.triangles[t];
                replace_vertex(half, edge.a, middle);
                replace_vertex(mesh.triangles[t], edge.b, middle);
                mesh.triangles.push_back(half);
            }
        }
    }
}

void collapse_short_edges(TriangleMesh& mesh, std::vector<double>& target) {
    for (int pass = 0; pass < kPasses; ++pass) {
        const std::vector<Edge> edges = find_edges(mesh);
        const auto rank = rank_edges(mesh, target, edges, -1.0, 0.8);
        if (rank.empty()) break;
        const VertexTriangles ring = find_vertex_triangles(mesh);
        // Vertices near an edit wait for the next pass, so `ring` stays valid for the others.
        std::vector<bool> locked(mesh.position.size(), false);
        for (const RankedEdge& short_edge : rank) {
            const std::uint32_t a = edges[short_edge.index].a, b = edges[short_edge.index].b;
            if (locked[a] || locked[b]) continue;
            const auto near_a = neighbours(mesh, ring, a), near_b = neighbours(mesh, ring, b);
            std::vector<std::uint32_t> common;
            std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(),
                                  std::back_inserter(common));
            // More than two common neighbours: the merge would pinch the surface.
            if (common.size() != 2 || near_a.size() + near_b.size() < 10) continue;
            const auto is_locked = [&](std::uint32_t v) { return locked[v]; };
            if (std::any_of(near_a.begin(), near_a.end(), is_locked) ||
                std::any_of(near_b.begin(), near_b.end(), is_locked)) {
                continue;
            }
            const glm::dvec3 middle = 0.5 * (mesh.position[a] + mesh.position[b]);
            if (!may_move(mesh, ring, a, b, middle) || !may_move(mesh, ring, b, a, middle)) {
                continue;
            }
            mesh.position[a] = middle;
            mesh.normal[a] = glm::normalize(mesh.normal[a] + 0.999 * mesh.normal[b]);
            target[a] = std::min(target[a], target[b]);
            for (std::size_t i = ring.begin[b]; i < ring.begin[b + 1]; ++i) {
                replace_vertex(mesh.triangles[ring.triangle[i]], b, a);
            }
            for (const auto* near : {&near_a, &near_b}) {
                for (const std::uint32_t v : *near) {
                    locked[v] = true;
                }
            }
        }
        compact(mesh, target);
    }
}

void flip_to_delaunay(TriangleMesh& mesh) {
    for (int pass = 0; pass < kPasses; ++pass) {
        const std::vector<Edge> edges = find_edges(mesh);
        const auto joined = [&](std::uint32_t a, std::uint32_t b) {
            const std::pair key(std::min(a, b), std::max(a, b));
            const auto at = std::lower_bound(edges.begin(), edges.end(), key,
                                             [](const Edge& edge, const auto& wanted) {
                                                 return std::pair(edge.a, edge.b) < wanted;
                                             });
            return at != edges.end() && std::pair(at->a, at->b) == key;
        };
        std::set<std::pair<std::uint32_t, std::uint32_t>> added;
        std::vector<bool> touched(mesh.triangles.size(), false);
        for (const Edge& edge : edges) {
            if (touched[edge.left] || touched[edge.right]) continue;
            const std::uint32_t a = edge.a, b = edge.b,
                                c = opposite_vertex(mesh.triangles[edge.left], a, b),
                                d = opposite_vertex(mesh.triangles[edge.right], a, b);
            const auto& p = mesh.position;
            const auto cotangent = [&](std::uint32_t apex) {
                const glm::dvec3 u = p[a] - p[apex], v = p[b] - p[apex];
                return glm::dot(u, v) / std::max(glm::length(glm::cross(u, v)), 1e-12);
            };
            // A negative sum of cotangents: the angles sum to more than 180 degrees.
            if (cotangent(c) + cotangent(d) >= -1e-6) continue;
            const Triangle left{c, a, d}, right{d, b, c};
            const glm::dvec3 n0 = area_vector(mesh, mesh.triangles[edge.left]),
                             n1 = area_vector(mesh, mesh.triangles[edge.right]),
                             m0 = area_vector(mesh, left), m1 = area_vector(mesh, right);
            const auto aligned = [](const glm::dvec3& u, const glm::dvec3& v) {
                return glm::dot(u, v) > 0.7 * glm::length(u) * glm::length(v);
            };
            const glm::dvec3 mean = n0 + n1;
            if (!aligned(m0, m1) || !aligned(m0, mean) || !aligned(m1, mean)) continue;
            const std::pair key(std::min(c, d), std::max(c, d));
            if (joined(c, d) || added.contains(key)) continue;
            added.insert(key);
            touched[edge.left] = touched[edge.right] = true;
            mesh.triangles[edge.left] = left;
            mesh.triangles[edge.right] = right;
        }
        if (added.empty()) break;
    }
}

VertexTriangles find_vertex_triangles(const TriangleMesh& mesh) {
    VertexTriangles ring;
    ring.begin.assign(mesh.position.size() + 1, 0);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle) {
            ++ring.begin[v + 1];
        }
    }
    for (std::size_t v = 1; v < ring.begin.size(); ++v) {
        ring.begin[v] += ring.begin[v - 1];
    }
    ring.triangle.resize(ring.begin.back());
    std::vector<std::size_t> next(ring.begin.begin(), ring.begin.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t]) {
            ring.triangle[next[v]++] = t;
        }
    }
    return ring;
}

std::vector<Edge> find_edges(const TriangleMesh& mesh) {
    struct Side {
        std::uint32_t other, triangle;
        bool forward;  ///< runs from the vertex to `other`
    };
    const VertexTriangles ring = find_vertex_triangles(mesh);
    std::vector<Edge> edges;
    edges.reserve(mesh.triangles.size() * 3 / 2);
    std::vector<Side> sides;
    for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
        sides.clear();
        for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
            const std::uint32_t triangle = ring.triangle[i];
            const Triangle& t = mesh.triangles[triangle];
            const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
            const std::uint32_t next = t[(at + 1) % 3], previous = t[(at + 2) % 3];
            if (v < next) sides.push_back({next, triangle, true});
            if (v < previous) sides.push_back({previous, triangle, false});
        }
        std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
            return std::tie(s.other, s.triangle) < std::tie(t.other, t.triangle);
        });
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i + 1;
            while (end < sides.size() && sides[end].other == sides[i].other) {
                ++end;
            }
            if (end - i == 2 && sides[i].forward != sides[i + 1].forward) {
                const bool first = sides[i].forward;
                edges.push_back({v, sides[i].other, sides[first ? i : i + 1].triangle,
                                 sides[first ? i + 1 : i].triangle});
            }
            i = end;
        }
    }
    return edges;
}

}  // namespace opaline::bake
