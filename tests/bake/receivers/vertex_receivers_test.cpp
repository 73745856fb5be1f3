#include "bake/receivers/vertex_receivers.h"

#include <gtest/gtest.h>

#include "bake/receivers/body_points.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

TEST(VertexReceivers, DirectionLiesInTheMiddleOfTheNormals) {
    const glm::vec3 corner[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Clearance c = clearest_direction(corner);
    EXPECT_NEAR(c.cosine, 1 / std::sqrt(3.0f), 1e-3f);
    // A repeated normal must not attract the direction.
    const glm::vec3 uneven[] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}};
    EXPECT_GT(clearest_direction(uneven).cosine, 0.6f);
}

TEST(VertexReceivers, BackToBackSheetsHaveNoClearance) {
    const glm::vec3 sheets[] = {{0, 1, 0}, {0, -1, 0}};
    EXPECT_LE(clearest_direction(sheets).cosine, 0.0f);
}

TEST(VertexReceivers, OriginsLieInFrontOfAllTrianglesOfTheVertex) {
    const auto scene = tests::make_scene(
        {tests::transformed(tests::make_cube(3, true), tests::some_rotation(), 2, {5, 5, 5})});
    const auto receivers = make_vertex_receivers(scene);
    const auto& p = scene.primitives[0];
    for (std::size_t t = 0; t < p.index.size(); t += 3) {
        const glm::dvec3 a = p.position[p.index[t]];
        const glm::dvec3 normal =
            glm::normalize(glm::cross(glm::dvec3(p.position[p.index[t + 1]]) - a,
                                      glm::dvec3(p.position[p.index[t + 2]]) - a));
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GT(glm::dot(glm::dvec3(receivers[p.index[t + k]].origin) - a, normal), 0);
        }
    }
}

// Small triangles in a large scene: the offset depends on the rounding of the vertex and the extent
// of its triangles, not on the extent of the scene.
TEST(VertexReceivers, OffsetsOfFineTrianglesAreNoMoreThanAFewRoundings) {
    for (const float x : {0.0f, 10.0f, 30.0f}) {
        const auto scene = tests::make_scene({tests::make_sphere(4, 0.01f, {x, 0, 0})});
        const auto receivers = make_vertex_receivers(scene);
        for (std::size_t v = 0; v < receivers.size(); ++v) {
            const float offset =
                glm::distance(receivers[v].origin, scene.primitives[0].position[v]);
            EXPECT_GT(offset, 0);
            EXPECT_LT(offset, 6e-7f * (x + 0.02f)) << x;
        }
    }
}

// A flap as in scans: two triangles folded onto each other rise above the surface. Rays from below
// the flap would give a black vertex.
TEST(VertexReceivers, RaysOfAFoldedVertexStartAboveTheFold) {
    formats::Primitive flap;
    flap.position = {{0, 0, 0}, {1, 0.1f, 0}, {0, 0.1f, 1}, {1, 0, 1}};
    flap.normal.assign(4, {0, 1, 0});
    flap.index = {0, 2, 1, 0, 1, 2};
    const auto receivers = make_vertex_receivers(tests::make_scene({flap}));
    EXPECT_GT(receivers[0].origin.y, 0.1f);
    EXPECT_LT(receivers[0].origin.y, 0.1f + 1e-4f);
    EXPECT_LT(receivers[1].origin.y, 0.1f + 1e-4f);
}

TEST(VertexReceivers, LooseVerticesAreReceiversToo) {
    auto scene = tests::make_scene({tests::make_sphere(0)});
    scene.primitives[0].position.push_back({9, 9, 9});
    scene.primitives[0].normal.push_back({0, 1, 0});
    EXPECT_EQ(make_vertex_receivers(scene).back().origin, glm::vec3(9, 9, 9));
}

// A cube of 2 m in cells of .5 m: vertices of edges look from up to two mean free paths inside
// their own face, others from where they are.
TEST(BodyPoints, VertexOfASharpEdgeLooksFromBesideItUnderItsOwnFace) {
    for (const float sigma_t : {100.0f, 1.0f}) {
        const auto scene = tests::make_translucent_scene({tests::make_cube(4, false)},
                                                         tests::make_grey_medium(sigma_t, 0));
        const auto points = make_body_points(scene, make_vertex_receivers(scene));
        for (const BodyPoint& point : points) {
            const glm::vec3 at = glm::abs(point.position);
            const int edges = (at.x == 1) + (at.y == 1) + (at.z == 1) - 1;
            EXPECT_NEAR(glm::dot(point.aside, point.normal), 0, 1e-6f);
            EXPECT_LT(glm::length(point.aside), std::min(2.0001f / sigma_t, 0.4f));
            if (edges == 0) {
                EXPECT_EQ(point.aside, glm::vec3(0));
                continue;
            }
            for (int axis = 0; axis < 3; ++axis) {
                if (at[axis] == 1 && point.normal[axis] == 0) {
                    EXPECT_LT(std::abs(step_aside(point).position[axis]),
                              sigma_t > 10 ? 0.995f : 0.9f);
                }
            }
        }
    }
}

// One vertex for all faces has no face of its own.
TEST(BodyPoints, VertexThatFacesShareStaysInItsPlace) {
    const auto ball =
        tests::make_translucent_scene({tests::make_sphere(2)}, tests::make_grey_medium(1, 0));
    for (const BodyPoint& point : make_body_points(ball, make_vertex_receivers(ball))) {
        EXPECT_EQ(point.aside, glm::vec3(0));
    }
}

}  // namespace
}  // namespace opaline::bake
