#include "bake/example/edges.h"

#include <tuple>

namespace opaline::bake {

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
