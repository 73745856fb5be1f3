// Requirements of example scenes for baking: closed surfaces, outward faces, well-shaped triangles.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "bake/lab/example/example_scenes.h"
#include "bake/lab/example/solid_mesh.h"
#include "tests/bake/example/facing.h"

namespace opaline::bake {
namespace {

/// Scenes are made once for all tests: the statue takes seconds.
const std::vector<GltfObject>& scene(std::string_view name) {
    static std::map<std::string, std::vector<GltfObject>, std::less<>> made;
    auto at = made.find(name);
    if (at == made.end()) {
        auto objects = make_example(name);
        at = made.emplace(std::string(name), std::move(objects).value()).first;
    }
    return at->second;
}

const TriangleMesh& figure(std::string_view name) {
    return scene(name).front().mesh;
}

const TriangleMesh& floor_of(std::string_view name) {
    return scene(name).back().mesh;
}

/// How often each directed edge occurs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++count[{t[i], t[(i + 1) % 3]}];
        }
    }
    return count;
}

/// Edges that are not shared by exactly two triangles running along it in opposite directions.
std::size_t open_edges(const TriangleMesh& mesh) {
    const auto count = directed_edges(mesh);
    return static_cast<std::size_t>(
        std::count_if(count.begin(), count.end(), [&](const auto& entry) {
            const auto& [edge, times] = entry;
            return times != 1 || !count.contains({edge.second, edge.first});
        }));
}

/// Vertices whose triangles form more than one fan: surfaces that touch in a point.
std::size_t pinched_vertices(const TriangleMesh& mesh) {
    std::vector<std::map<std::uint32_t, std::uint32_t>> link(mesh.position.size());
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            link[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
        }
    }
    return static_cast<std::size_t>(std::count_if(link.begin(), link.end(), [](const auto& ring) {
        if (ring.empty()) return true;
        std::size_t steps = 0;
        std::uint32_t at = ring.begin()->first;
        do {
            const auto next = ring.find(at);
            if (next == ring.end()) return true;
            at = next->second;
        } while (++steps <= ring.size() && at != ring.begin()->first);
        return steps != ring.size();
    }));
}

long euler_characteristic(const TriangleMesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, times] : directed_edges(mesh)) {
        edges.insert(std::minmax(edge.first, edge.second));
    }
    return static_cast<long>(mesh.position.size()) - static_cast<long>(edges.size()) +
           static_cast<long>(mesh.triangles.size());
}

glm::dvec3 face_normal(const TriangleMesh& mesh, const Triangle& t) {
    return glm::normalize(glm::cross(mesh.position[t[1]] - mesh.position[t[0]],
                                     mesh.position[t[2]] - mesh.position[t[0]]));
}

/// Smallest angle of each triangle, in degrees, sorted.
std::vector<double> smallest_angles(const TriangleMesh& mesh) {
    std::vector<double> angles;
    for (const Triangle& t : mesh.triangles) {
        double smallest = 180.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 u = mesh.position[t[(i + 1) % 3]] - mesh.position[t[i]],
                             v = mesh.position[t[(i + 2) % 3]] - mesh.position[t[i]];
            const double angle = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
            smallest = std::min(smallest, angle * 180.0 / std::numbers::pi);
        }
        angles.push_back(smallest);
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

/// Positions as the file holds them: rounding to float must not make two vertices one.
std::size_t coinciding_vertices(const TriangleMesh& mesh) {
    std::set<std::array<float, 3>> seen;
    for (const glm::dvec3& p : mesh.position) {
        const glm::vec3 rounded(p);
        seen.insert({rounded.x, rounded.y, rounded.z});
    }
    return mesh.position.size() - seen.size();
}

TriangleMesh make_ball(double radius) {
    const ScalarField ball = [=](const glm::dvec3& p) { return glm::length(p) - radius; };
    TriangleMesh mesh =
        polygonize(ball, {glm::dvec3(-radius - 2.0), glm::dvec3(radius + 2.0)}, 0.9);
    remesh(ball, RemeshOptions{}, mesh);
    return mesh;
}

class ExampleFigure : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, ExampleFigure,
                         testing::Values("statue", "knot", "glossy", "first-scene"),
                         [](const auto& scene_name) {
                             std::string name = scene_name.param;
                             std::erase(name, '-');
                             return name;
                         });

TEST_P(ExampleFigure, IsAClosedTwoManifoldThatFacesOutward) {
    EXPECT_EQ(open_edges(figure(GetParam())), 0u);
    EXPECT_EQ(pinched_vertices(figure(GetParam())), 0u);
    EXPECT_EQ(coinciding_vertices(figure(GetParam())), 0u);
    EXPECT_GT(enclosed_volume(figure(GetParam())), 0.0);
}

TEST_P(ExampleFigure, HasUnitNormalsOnTheSideOfItsFaces) {
    const TriangleMesh& mesh = figure(GetParam());
    ASSERT_EQ(mesh.normal.size(), mesh.position.size());
    for (const glm::dvec3& n : mesh.normal) {
        ASSERT_NEAR(glm::length(n), 1.0, 1e-9);
    }
    double worst = 1.0;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            worst = std::min(worst, glm::dot(face_normal(mesh, t), mesh.normal[v]));
        }
    }
    // Feather rims and notches bend by up to a right angle within a triangle, but none folds over.
    EXPECT_GT(worst, 0.2);
}

TEST_P(ExampleFigure, HasRoundTriangles) {
    const std::vector<double> angles = smallest_angles(figure(GetParam()));
    EXPECT_GT(angles.front(), 10.0);
    EXPECT_GT(angles[angles.size() / 100], 25.0);
}

TEST_P(ExampleFigure, RestsOnTheFloor) {
    const auto& points = figure(GetParam()).position;
    const auto [low, high] =
        std::ranges::minmax_element(points, {}, [](const glm::dvec3& p) { return p.y; });
    // Sunk by 0.4 mm: deep enough that no face lies in the floor, too little to be seen.
    EXPECT_NEAR(low->y, -0.0004, 0.0001);
    const std::map<std::string, double> height = {
        {"statue", 0.12}, {"knot", 0.24}, {"glossy", 0.06}, {"first-scene", 0.465}};
    EXPECT_NEAR(high->y, height.at(GetParam()), 0.05 * height.at(GetParam()));
}

TEST_P(ExampleFigure, StandsOnAFloorWithoutHolesOrHangingCorners) {
    const TriangleMesh& floor = floor_of(GetParam());
    const auto edges = directed_edges(floor);
    double side = 0.0;
    for (const glm::dvec3& p : floor.position) {
        side = std::max(side, p.x);
    }
    double border = 0.0;
    for (const auto& [edge, times] : edges) {
        ASSERT_EQ(times, 1);
        if (edges.contains({edge.second, edge.first})) continue;
        const glm::dvec3 &a = floor.position[edge.first], &b = floor.position[edge.second];
        // An edge of one triangle alone must lie on the rim of the square.
        ASSERT_NEAR(std::max(std::abs(a.x + b.x), std::abs(a.z + b.z)), 2.0 * side, 1e-12);
        border += glm::distance(a, b);
    }
    EXPECT_NEAR(border, 8.0 * side, 1e-9);
    EXPECT_EQ(euler_characteristic(floor), 1);  // a disc
}

TEST(StatueExample, HasThirtyThousandVerticesAThickBodyAndNoHandles) {
    const TriangleMesh& statue = figure("statue");
    EXPECT_GE(statue.position.size(), 30000u);
    EXPECT_LE(statue.position.size(), 46000u);
    EXPECT_EQ(euler_characteristic(statue), 2);
    // Water displaced by 45 mm of body: a hollow or inside-out figure would miss this by far.
    EXPECT_GT(enclosed_volume(statue), 1.5e-4);
    EXPECT_LT(enclosed_volume(statue), 3.0e-4);
}

TEST(KnotExample, IsATorus) {
    EXPECT_EQ(euler_characteristic(figure("knot")), 0);
}

TEST(GlossyExample, HasThreeBallsOfTheirVolumeThatDoNotTouch) {
    const auto& objects = scene("glossy");
    ASSERT_EQ(objects.size(), 4u);
    for (std::size_t i = 0; i < 3; ++i) {
        const TriangleMesh& ball = objects[i].mesh;
        EXPECT_EQ(ball.position.size(), 2562u);
        EXPECT_EQ(euler_characteristic(ball), 2);
        const double exact = 4.0 / 3.0 * std::numbers::pi * 0.03 * 0.03 * 0.03;
        EXPECT_NEAR(enclosed_volume(ball), exact, 0.01 * exact);
        const double middle = 0.07 * (static_cast<double>(i) - 1);
        for (const glm::dvec3& p : ball.position) {
            ASSERT_LT(std::abs(p.x - middle), 0.0301);
        }
    }
}

TEST(FirstSceneExample, HasAFloorOfTwoTrianglesAFlatCubeAndClosedThingsBesideEachOther) {
    const auto& objects = scene("first-scene");
    ASSERT_EQ(objects.size(), 5u);
    EXPECT_EQ(floor_of("first-scene").position.size(), 4u);
    EXPECT_EQ(euler_characteristic(objects[0].mesh), 2);
    const TriangleMesh &torus = objects[2].mesh, &cube = objects[3].mesh;
    EXPECT_EQ(open_edges(torus), 0u);
    EXPECT_EQ(euler_characteristic(torus), 0);
    EXPECT_EQ(cube.position.size(), 24u);
    EXPECT_EQ(cube.position.size() - coinciding_vertices(cube), 8u);
    EXPECT_NEAR(enclosed_volume(cube), 0.48 * 0.48 * 0.48, 1e-9);
    for (const GltfObject& object : objects) {
        expect_facing_normals(object.mesh);
        for (const glm::dvec3& p : object.mesh.position) {
            ASSERT_LE(std::max(std::abs(p.x), std::abs(p.z)), 2.0);
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {  // the light between them has room: nothing touches
        for (std::size_t j = 0; j < i; ++j) {
            for (const glm::dvec3& p : objects[i].mesh.position) {
                for (const glm::dvec3& q : objects[j].mesh.position) {
                    ASSERT_GT(glm::distance(p, q), 0.02);
                }
            }
        }
    }
}

TEST(Remesh, PutsABallOnItsSphere) {
    constexpr double kRadius = 9.0;
    const TriangleMesh ball = make_ball(kRadius);
    EXPECT_EQ(open_edges(ball), 0u);
    EXPECT_EQ(euler_characteristic(ball), 2);
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        ASSERT_NEAR(glm::length(ball.position[v]), kRadius, 1e-6);
        ASSERT_NEAR(glm::dot(ball.normal[v], ball.position[v]), kRadius, 1e-3);
    }
    // Chords cut the volume by less than the area times the wanted deviation of 0.03 mm.
    const double exact = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
    EXPECT_NEAR(enclosed_volume(ball), exact, 4.0 * std::numbers::pi * kRadius * kRadius * 0.03);
}

TEST(Polygonize, StaysManifoldWhereTheSolidIsThinnerThanTheGrid) {
    // Two sheets closer than a cell, and a rod along a cell diagonal: every ambiguous case occurs.
    const ScalarField field = [](const glm::dvec3& p) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(1.0, 1.1, 0.9));
        const double rod = glm::length(p - glm::dot(p, d) * d) - 0.55;
        const double sheets = std::abs(std::abs(p.x + 0.3 * p.y - 0.2 * p.z) - 0.7) - 0.45;
        return smooth_intersection(std::min(rod, sheets), glm::length(p) - 8.0, 0.5);
    };
    const TriangleMesh mesh = polygonize(field, {glm::dvec3(-10.0), glm::dvec3(10.0)}, 1.0);
    ASSERT_GT(mesh.triangles.size(), 500u);
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_EQ(pinched_vertices(mesh), 0u);
}

}  // namespace
}  // namespace opaline::bake
