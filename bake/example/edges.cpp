#include "bake/example/edges.h"

#include <tuple>

namespace opaline::bake {

std::vector<Edge> find_edges(const TriangleMesh& mesh) {
    struct Side {
        std::uint32_t low, high, triangle;
        bool forward;  ///< runs from low to high
    };
    std::vector<Side> sides;
    sides.reserve(mesh.triangles.size() * 3);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.low, s.high, s.triangle) < std::tie(t.low, t.high, t.triangle);
    });
    std::vector<Edge> edges;
    edges.reserve(sides.size() / 2);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low &&
               sides[end].high == sides[i].high) {
            ++end;
        }
        if (end - i == 2 && sides[i].forward != sides[i + 1].forward) {
            const std::size_t left = sides[i].forward ? i : i + 1;
            edges.push_back({sides[i].low, sides[i].high, sides[left].triangle,
                             sides[left == i ? i + 1 : i].triangle});
        }
        i = end;
    }
    return edges;
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

}  // namespace opaline::bake
