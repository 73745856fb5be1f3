#include "bake/lab/example/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bake/base/parallel_indices.h"
#include "bake/lab/example/edit_mesh.h"

namespace opaline::bake {
namespace {

/// Sets every vertex's normal, after moving it toward the surface along the normal it has.
void drop_onto_surface(const ScalarField& field, double step, TriangleMesh& mesh) {
    for_each_index(mesh.position.size(), [&](std::size_t v) {
        glm::dvec3 &p = mesh.position[v], &n = mesh.normal[v];
        if (glm::dot(n, n) > 0.0) {
            // Bounded, so that a bad guess beside a crease cannot fling a vertex away.
            p -= std::clamp(field(p), -0.5, 0.5) * n;
        }
        const glm::dvec3 slope = gradient(field, p, step);
        const double length = glm::length(slope);
        n = length > 1e-9 ? slope / length : glm::dvec3(0.0, 1.0, 0.0);
    });
}

/// Target edge length at each vertex, from how fast the normal turns along its edges: a chord over
/// an arc of curvature k deviates from it by about length^2 k / 8.
std::vector<double> edge_targets(const TriangleMesh& mesh, const RemeshOptions& options) {
    std::vector<double> curvature(mesh.position.size(), 0.0);
    const std::vector<Edge> edges = find_edges(mesh);
    for (const Edge& edge : edges) {
        const double length = glm::distance(mesh.position[edge.a], mesh.position[edge.b]);
        const double turn = glm::distance(mesh.normal[edge.a], mesh.normal[edge.b]);
        const double k = turn / std::max(length, 0.25 * options.shortest);
        curvature[edge.a] = std::max(curvature[edge.a], k);
        curvature[edge.b] = std::max(curvature[edge.b], k);
    }
    std::vector<double> target(curvature.size());
    for (std::size_t v = 0; v < target.size(); ++v) {
        const double length = std::sqrt(8.0 * options.deviation / std::max(curvature[v], 1e-6));
        target[v] = std::clamp(length, options.shortest, options.longest);
    }
    // Graded: neighbouring triangles of very different size would be slivers.
    for (int pass = 0; pass < 4; ++pass) {
        for (const Edge& edge : edges) {
            const double reach = 0.3 * glm::distance(mesh.position[edge.a], mesh.position[edge.b]);
            target[edge.a] = std::min(target[edge.a], target[edge.b] + reach);
            target[edge.b] = std::min(target[edge.b], target[edge.a] + reach);
        }
    }
    return target;
}

/// Moves each vertex along the surface toward the centroid of its triangles, weighted by area over
/// target.
void relax(const std::vector<double>& target, TriangleMesh& mesh) {
    const VertexTriangles ring = find_vertex_triangles(mesh);
    std::vector<glm::dvec3> moved(mesh.position.size());
    for_each_index(mesh.position.size(), [&](std::size_t v) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
            const Triangle& t = mesh.triangles[ring.triangle[i]];
            const double size = (target[t[0]] + target[t[1]] + target[t[2]]) / 3.0;
            const double weight = glm::length(area_vector(mesh, t)) / (size * size * size * size);
            sum += weight / 3.0 * (mesh.position[t[0]] + mesh.position[t[1]] + mesh.position[t[2]]);
            weights += weight;
        }
        const glm::dvec3 offset =
            weights > 0.0 ? sum / weights - mesh.position[v] : glm::dvec3(0.0);
        const glm::dvec3& n = mesh.normal[v];
        moved[v] = mesh.position[v] + 0.9 * (offset - glm::dot(offset, n) * n);
    });
    mesh.position = std::move(moved);
}

/// Where the surface folds tighter than the mesh can follow (the ends of narrow notches), triangles
/// may face away from the field's normal. Vertices there move to the middle of their neighbours and
/// take the mean normal of their triangles: a fillet of about an edge length.
void round_tight_folds(TriangleMesh& mesh) {
    constexpr double kTightest = 0.4;  ///< cosine between a vertex's normal and its triangles'
    const VertexTriangles ring = find_vertex_triangles(mesh);
    for (int pass = 0; pass < 30; ++pass) {
        std::vector<bool> folded(mesh.position.size(), false);
        for (const Triangle& triangle : mesh.triangles) {
            const glm::dvec3 area = area_vector(mesh, triangle);
            for (const std::uint32_t v : triangle) {
                if (glm::dot(area, mesh.normal[v]) >= kTightest * glm::length(area)) continue;
                for (const std::uint32_t corner : triangle) {
                    folded[corner] = true;
                }
            }
        }
        if (std::find(folded.begin(), folded.end(), true) == folded.end()) return;
        const std::vector<glm::dvec3> before = mesh.position;
        for (std::size_t v = 0; v < folded.size(); ++v) {
            if (!folded[v]) continue;
            glm::dvec3 sum(0.0);
            double count = 0.0;
            for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
                for (const std::uint32_t corner : mesh.triangles[ring.triangle[i]]) {
                    if (corner == v) continue;
                    sum += before[corner];
                    count += 1.0;
                }
            }
            mesh.position[v] = glm::mix(before[v], sum / count, 0.7);
        }
        for (std::size_t v = 0; v < folded.size(); ++v) {
            if (!folded[v]) continue;
            glm::dvec3 sum(0.0);
            for (std::size_t i = ring.begin[v]; i < ring.begin[v + 1]; ++i) {
                const glm::dvec3 area = area_vector(mesh, mesh.triangles[ring.triangle[i]]);
                sum += area / std::max(glm::length(area), 1e-12);
            }
            const double length = glm::length(sum);
            if (length > 1e-9) mesh.normal[v] = sum / length;
        }
    }
}

}  // namespace

void remesh(const ScalarField& field, const RemeshOptions& options, TriangleMesh& mesh) {
    const double step = 0.1 * options.shortest;
    mesh.normal.assign(mesh.position.size(), glm::dvec3(0.0));
    drop_onto_surface(field, step, mesh);
    drop_onto_surface(field, step, mesh);
    for (int round = 0; round < options.rounds; ++round) {
        std::vector<double> target = edge_targets(mesh, options);
        const bool last = round + 1 == options.rounds;
        if (!last) {
            split_long_edges(mesh, target);
            collapse_short_edges(mesh, target);
        }
        flip_to_delaunay(mesh);
        relax(target, mesh);
        drop_onto_surface(field, step, mesh);
        flip_to_delaunay(mesh);
    }
    drop_onto_surface(field, step, mesh);
    drop_onto_surface(field, step, mesh);
    round_tight_folds(mesh);
}

}  // namespace opaline::bake
