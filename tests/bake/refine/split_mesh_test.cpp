#include "bake/refine/split_mesh.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// Halves triangles all over, again and again, in an order of no pattern.
Scene halved(const Scene& scene, std::uint32_t times, SplitMesh::CutRule rule = nullptr) {
    SplitMesh mesh(scene, std::move(rule));
    std::vector<SplitMesh::Half> halves;
    std::uint32_t drawn = 1;
    for (std::uint32_t i = 0; i < times; ++i) {
        drawn = drawn * 1664525u + 1013904223u;
        mesh.halve((drawn >> 8) % mesh.size(), halves);
    }
    return mesh.take();
}

using Place = std::array<float, 3>;
Place place_of(const Primitive& p, std::uint32_t v) {
    return {p.position[v].x, p.position[v].y, p.position[v].z};
}

// How often an edge goes from one place to another, over all primitives.
std::map<std::pair<Place, Place>, int> count_edges(const Scene& scene) {
    std::map<std::pair<Place, Place>, int> count;
    for (const Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.index.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            ++count[{place_of(p, p.index[i]), place_of(p, p.index[next])}];
        }
    }
    return count;
}

double area_of(const Scene& scene) {
    double sum = 0;
    for (const Primitive& p : scene.primitives) {
        sum += formats::surface_area(p);
    }
    return sum;
}

double smallest_angle(const Scene& scene) {
    double smallest = 4;
    for (const Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.index.size(); ++i) {
            const std::size_t first = i - i % 3;
            const glm::dvec3 a = p.position[p.index[i]];
            const glm::dvec3 b = p.position[p.index[first + (i + 1) % 3]];
            const glm::dvec3 c = p.position[p.index[first + (i + 2) % 3]];
            const double cosine = glm::dot(glm::normalize(b - a), glm::normalize(c - a));
            smallest = std::min(smallest, std::acos(std::min(1.0, cosine)));
        }
    }
    return smallest;
}

// A closed cube whose sides share no vertices, two of them in a primitive of their own.
Scene seamed_cube() {
    Primitive cube = tests::transformed(tests::make_cube(2, false), tests::some_rotation(), 1, {});
    Primitive other = cube;
    const auto part = static_cast<std::ptrdiff_t>(cube.index.size() / 3);
    other.index.erase(other.index.begin() + part, other.index.end());
    cube.index.erase(cube.index.begin(), cube.index.begin() + part);
    return tests::make_scene({cube, other});
}

TEST(SplitMesh, EveryEdgeOfAClosedSurfaceIsSharedOverSeamsAndPrimitives) {
    const Scene scene = halved(seamed_cube(), 500);
    EXPECT_GT(scene.primitives[0].added.size() + scene.primitives[1].added.size(), 400u);
    const auto edges = count_edges(scene);
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

TEST(SplitMesh, EdgesWhereThreeSurfacesMeetStayShared) {
    const glm::vec3 up(0, 1, 0), along(0, 0, 2);
    const Scene scene = halved(tests::make_scene({tests::make_quad({0, 0, 0}, along, {1, 0, 0}),
                                                  tests::make_quad({0, 0, 0}, along, {-1, 0, 0.3f}),
                                                  tests::make_quad({0, 0, 0}, along, up)}),
                               100);
    std::array<std::set<float>, 3> on_edge;  // where vertices lie along it
    for (std::size_t i = 0; i < 3; ++i) {
        for (const glm::vec3& x : scene.primitives[i].position) {
            if (x.x == 0 && x.y == 0) on_edge[i].insert(x.z);
        }
    }
    EXPECT_GT(on_edge[0].size(), 4u);
    EXPECT_EQ(on_edge[0], on_edge[1]);
    EXPECT_EQ(on_edge[0], on_edge[2]);
}

TEST(SplitMesh, AreaStaysAndNoAngleFallsBelowHalf) {
    const Scene before = seamed_cube(), after = halved(before, 2000);
    EXPECT_NEAR(area_of(after), area_of(before), 1e-5 * area_of(before));
    EXPECT_GT(smallest_angle(after), 0.499 * smallest_angle(before));
}

TEST(SplitMesh, AddedVerticesLieWhereTheirWeightsSay) {
    Scene scene = tests::make_scene({tests::make_sphere(1)});
    Primitive& given = scene.primitives[0];
    for (const glm::vec3& x : given.position) {
        given.texcoord.emplace_back(x.x, x.z);
        given.color.push_back({x.y, 0.5f, 1});
    }
    const Scene after = halved(scene, 300);
    const Primitive& p = after.primitives[0];
    ASSERT_GT(p.added.size(), 200u);
    ASSERT_EQ(p.texcoord.size(), p.position.size());
    const std::size_t first = p.position.size() - p.added.size();
    ASSERT_EQ(first, given.position.size());
    for (std::size_t i = 0; i < p.added.size(); ++i) {
        const auto [a, b, c] = p.added[i].corner;
        const std::array<float, 3> w = p.added[i].weights();
        const glm::vec3 at =
            w[0] * given.position[a] + w[1] * given.position[b] + w[2] * given.position[c];
        EXPECT_LT(glm::distance(p.position[first + i], at), 1e-6f);
        EXPECT_NEAR(p.texcoord[first + i].x, at.x, 1e-6f);
        EXPECT_NEAR(p.color[first + i].r, at.y, 1e-6f);
        EXPECT_NEAR(glm::length(p.normal[first + i]), 1, 1e-6f);
        EXPECT_GT(glm::dot(p.normal[first + i], glm::normalize(at)), 0.9f);
    }
}

// Where the plane y = 0.4375 cuts them, and a third along elsewhere.
EdgeCut cut_by_plane(glm::vec3 from, glm::vec3 to, std::span<const glm::vec3>) {
    const double share =
        (0.4375 - static_cast<double>(from.y)) / static_cast<double>(to.y - from.y);
    if (share > 1e-3 && share < 1 - 1e-3) return {share, 0};
    return {from.x + 2 * from.z < to.x + 2 * to.z ? 1 / 3.0 : 2 / 3.0, 0};
}

TEST(SplitMesh, EdgesThatAreCutBesideTheirMiddleStayShared) {
    const Scene before = seamed_cube(), after = halved(before, 1000, cut_by_plane);
    EXPECT_NEAR(area_of(after), area_of(before), 1e-5 * area_of(before));
    const auto edges = count_edges(after);
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    std::size_t in_plane = 0;
    for (const Primitive& p : after.primitives) {
        for (const glm::vec3& x : p.position) {
            in_plane += std::abs(x.y - 0.4375f) < 1e-6f ? 1 : 0;
        }
        for (const formats::AddedVertex& at : p.added) {
            EXPECT_TRUE(std::ranges::all_of(at.weights(), [](float w) { return w >= 0; }));
        }
    }
    EXPECT_GT(in_plane, 30u);
}

TEST(SplitMesh, TrianglesWithoutAreaStay) {
    Primitive quad = tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    quad.index.insert(quad.index.end(), {0, 0, 1, 0, 1, 1});
    const Scene after = halved(tests::make_scene({quad}), 20);
    EXPECT_EQ(std::count(after.primitives[0].index.begin() + 6,
                         after.primitives[0].index.begin() + 12, 1u),
              3);
    EXPECT_NEAR(area_of(after), 1, 1e-6);
}

}  // namespace
}  // namespace opaline::bake
