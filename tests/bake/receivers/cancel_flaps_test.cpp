#include "bake/scene/cancel_flaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bake/receivers/used_vertices.h"
#include "bake/scene/orient_bodies.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Scene wax_scene(std::vector<Primitive> primitives) {
    return tests::make_translucent_scene(std::move(primitives), tests::make_grey_medium(1, 0.1f));
}

// A triangle seen from both sides, each with corners of its own.
Primitive make_flap(float x) {
    Primitive flap;
    flap.position = {{x, 0, 0}, {x, 0.1f, 0}, {x, 0, 0.1f}, {x, 0, 0}, {x, 0.1f, 0}, {x, 0, 0.1f}};
    flap.normal.assign(3, {1, 0, 0});
    flap.normal.resize(6, {-1, 0, 0});
    flap.index = {0, 1, 2, 5, 4, 3};
    return flap;
}

// The body's own triangles stay as they are, whichever primitive holds the flaps.
TEST(CancelFlaps, PairsThatFaceOppositeWaysAreRemovedWhereverTheyStand) {
    const Primitive ball = tests::make_sphere(2);
    Primitive both = ball;
    const Primitive flap = make_flap(0.5f);
    const auto first = static_cast<std::uint32_t>(both.position.size());
    both.position.insert(both.position.end(), flap.position.begin(), flap.position.end());
    both.normal.insert(both.normal.end(), flap.normal.begin(), flap.normal.end());
    for (std::size_t i = 0; i < flap.index.size(); ++i) {
        // In the middle: what stands before and after is kept in order.
        both.index.insert(both.index.begin() + 30 + static_cast<std::ptrdiff_t>(i),
                          first + flap.index[i]);
    }
    const Scene scene = wax_scene({both, make_flap(3)});
    const Flaps flaps = find_flaps(scene, 0);
    EXPECT_EQ(flaps.pairs, 2u);
    EXPECT_THAT(flaps.first_index, ElementsAre(ElementsAre(30, 33), ElementsAre(0, 3)));
    const OrientedBodies bodies = orient_bodies(scene);
    ASSERT_TRUE(bodies.scene);
    EXPECT_EQ(bodies.scene->primitives[0].index, ball.index);
    EXPECT_EQ(bodies.scene->primitives[0].position, both.position) << "vertices are receivers";
    EXPECT_THAT(bodies.scene->primitives[1].index, IsEmpty());
    EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
    EXPECT_EQ(bodies.surfaces[0].turned, 0u);
    const auto warnings = describe_faults(scene, bodies.surfaces);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0].fault, HasSubstr("bound nothing and were left out: 2"));
}

TEST(CancelFlaps, OfThreeOnOneAnotherOneIsLeftToFaceTheWayOfTheMost) {
    Primitive ball = tests::make_sphere(2);
    const std::vector<std::uint32_t> closed = ball.index;
    for (const std::size_t k : {0u, 2u, 1u, 1u, 2u, 0u}) {
        ball.index.push_back(closed[k]);  // the first one again, once each way
    }
    const OrientedBodies bodies = orient_bodies(wax_scene({ball}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_EQ(bodies.scene->primitives[0].index.size(), closed.size());
    EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
}

// Faces that were copied, and an object that was: as many triangles as without them, one shell.
TEST(CancelFlaps, WhatIsThereTwiceIsThereOnce) {
    const Primitive ball = tests::make_sphere(1);
    Primitive half_twice = ball;
    half_twice.index.insert(
        half_twice.index.end(), ball.index.begin(),
        ball.index.begin() + static_cast<std::ptrdiff_t>(ball.index.size()) / 2);
    for (const Scene& scene : {wax_scene({half_twice}), wax_scene({ball, ball, ball})}) {
        const OrientedBodies bodies = orient_bodies(scene);
        ASSERT_TRUE(bodies.scene);
        EXPECT_EQ(bodies.scene->primitives[0].index, ball.index);
        std::size_t left = 0;
        for (const Primitive& p : bodies.scene->primitives) {
            left += p.index.size();
        }
        EXPECT_EQ(left, ball.index.size());
        EXPECT_EQ(bodies.surfaces[0].turned, 0u);
        EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
        EXPECT_EQ(bodies.surfaces[0].flaps, 0u);
        const auto warnings = describe_faults(scene, bodies.surfaces);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_THAT(warnings[0].fault, HasSubstr("lie on others and face the same way"));
    }
}

TEST(CancelFlaps, TrianglesThatOnlyShareAnEdgeStay) {
    EXPECT_EQ(find_flaps(wax_scene({tests::make_cube(3, false)}), 0).pairs, 0u);
    Scene others = wax_scene({tests::make_sphere(1), make_flap(3)});
    others.materials.push_back({.name = "Opaque"});
    others.primitives[1].material = 1;
    EXPECT_EQ(find_flaps(others, 0).pairs, 0u) << "opaque leaves may have two sides";
}

TEST(CancelFlaps, BodiesOfOneMediumThatTouchBecomeOne) {
    const Primitive cube = tests::make_cube(1, false);
    Primitive other = cube;  // mirrored, so that the sides that touch are cut alike
    for (std::size_t v = 0; v < other.position.size(); ++v) {
        other.position[v].x = 2 - other.position[v].x;
        other.normal[v].x = -other.normal[v].x;
    }
    for (std::size_t i = 0; i < other.index.size(); i += 3) {
        std::swap(other.index[i + 1], other.index[i + 2]);
    }
    const OrientedBodies bodies = orient_bodies(wax_scene({cube, other}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_EQ(bodies.surfaces[0].flaps, 2u);
    EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
    EXPECT_EQ(bodies.surfaces[0].turned, 0u);
    EXPECT_NEAR(formats::surface_area(bodies.scene->primitives[0]) +
                    formats::surface_area(bodies.scene->primitives[1]),
                40, 1e-4)
        << "that of a box of 4 x 2 x 2";
}

// One of them alone would be open there.
TEST(CancelFlaps, AFaceThatTwoOverlappingBodiesHaveInCommonStaysOneOfEach) {
    const Primitive cube = tests::make_cube(2, false);
    Primitive taller = cube;
    for (glm::vec3& p : taller.position) {
        p.y = p.y < 0 ? 2 * p.y : p.y;
    }
    EXPECT_EQ(find_flaps(wax_scene({cube, taller}), 0).repeats, 0u);
    EXPECT_EQ(find_flaps(wax_scene({cube, cube}), 0).repeats, cube.index.size() / 3);
}

// What consists of such pairs is meant.
TEST(CancelFlaps, ABodyOfNothingElseStays) {
    EXPECT_EQ(find_flaps(wax_scene({make_flap(0)}), 0).pairs, 0u);
    EXPECT_FALSE(orient_bodies(wax_scene({make_flap(0)})).scene);
}

TEST(CancelFlaps, TrianglesWithoutAreaAndEmptyScenesAreHarmless) {
    Primitive point = make_flap(0);
    point.position.assign(6, glm::vec3(1));
    EXPECT_EQ(find_flaps(wax_scene({point}), 0).pairs, 0u);
    EXPECT_EQ(find_flaps(wax_scene({}), 0).pairs, 0u);
}

TEST(UsedVertices, AreThoseOfTrianglesAndAllWhereThereIsNone) {
    Primitive corner = make_flap(0);
    corner.index = {5, 3, 0};
    EXPECT_THAT(find_used_vertices(wax_scene({corner, make_flap(1), corner})),
                ElementsAre(0, 3, 5, 6, 7, 8, 9, 10, 11, 12, 15, 17));
    corner.index.clear();
    EXPECT_THAT(find_used_vertices(wax_scene({corner})), ElementsAre(0, 1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace opaline::bake
