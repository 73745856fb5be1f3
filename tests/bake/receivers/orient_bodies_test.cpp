#include "bake/scene/orient_bodies.h"

#include <gtest/gtest.h>

#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;
using tests::make_grey_medium;
using tests::make_translucent_scene;
using tests::turned_inside_out;

Scene wax(std::vector<Primitive> primitives) {
    return make_translucent_scene(std::move(primitives), make_grey_medium(1, 0.1f));
}

// True if two surfaces have the same triangles, up to rotation of their corners.
bool same_triangles(const Primitive& a, const Primitive& b) {
    if (a.index.size() != b.index.size()) return false;
    for (std::size_t i = 0; i < a.index.size(); i += 3) {
        const std::uint32_t *s = &a.index[i], *t = &b.index[i];
        const bool same = (s[0] == t[0] && s[1] == t[1] && s[2] == t[2]) ||
                          (s[0] == t[1] && s[1] == t[2] && s[2] == t[0]) ||
                          (s[0] == t[2] && s[1] == t[0] && s[2] == t[1]);
        if (!same) return false;
    }
    return true;
}

TEST(OrientBodies, ClosedBodiesThatFaceOutwardStayAsTheyAre) {
    const OrientedBodies bodies = orient_bodies(
        wax({tests::make_sphere(2), tests::make_cube(3, false), tests::make_sphere(1, 0.2f)}));
    EXPECT_FALSE(bodies.scene);
    ASSERT_EQ(bodies.surfaces.size(), 1u);
    EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
    EXPECT_TRUE(describe_faults(wax({}), bodies.surfaces).empty());
}

TEST(OrientBodies, BodyInsideOutIsTurnedWithItsNormals) {
    const Primitive right = tests::make_sphere(2);
    const OrientedBodies bodies = orient_bodies(wax({turned_inside_out(right)}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], right));
    EXPECT_EQ(bodies.scene->primitives[0].normal, right.normal);
    EXPECT_EQ(bodies.surfaces[0].turned, right.index.size() / 3);
}

TEST(OrientBodies, NormalsThatPointOutwardAlreadyAreKept) {
    Primitive ball = tests::make_sphere(2);
    const std::vector<glm::vec3> outward = ball.normal;
    ball = turned_inside_out(std::move(ball));
    ball.normal = outward;
    const OrientedBodies bodies = orient_bodies(wax({ball}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_EQ(bodies.scene->primitives[0].normal, outward);
}

TEST(OrientBodies, SingleTrianglesFollowTheirNeighbours) {
    const Primitive right = tests::make_cube(4, false);  // sides meet by place, not by index
    Primitive wrong = right;
    for (const std::size_t t : {0u, 1u, 17u, 50u}) {
        std::swap(wrong.index[3 * t], wrong.index[3 * t + 1]);
    }
    const OrientedBodies bodies = orient_bodies(wax({wrong}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_EQ(bodies.surfaces[0].turned, 4u);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], right));
}

TEST(OrientBodies, CavitiesStayCavitiesEvenWhenAllIsInsideOut) {
    const Primitive outer = tests::make_sphere(2);
    const Primitive cavity = turned_inside_out(tests::make_sphere(1, 0.5f));
    EXPECT_FALSE(orient_bodies(wax({outer, cavity})).scene);
    const OrientedBodies bodies =
        orient_bodies(wax({turned_inside_out(cavity), turned_inside_out(outer)}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], cavity));
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[1], outer));
}

TEST(OrientBodies, ABodyBesideTheOthersIsTurnedByItself) {
    const Primitive right = tests::make_sphere(2);
    const Primitive wrong = turned_inside_out(tests::make_sphere(2, 1, {3, 0, 0}));
    const OrientedBodies bodies = orient_bodies(wax({right, wrong}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], right));
    EXPECT_EQ(bodies.surfaces[0].turned, wrong.index.size() / 3);
}

TEST(OrientBodies, HolesAreCountedByTheirEdgesAndTheRestStillFacesOutward) {
    Primitive body = tests::make_cube(2, false);
    body.index.resize(body.index.size() * 5 / 6);
    const OrientedBodies bodies = orient_bodies(wax({turned_inside_out(body)}));
    EXPECT_EQ(bodies.surfaces[0].open_edges, 8u);
    ASSERT_TRUE(bodies.scene);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], body));
    const auto warnings = describe_faults(wax({}), bodies.surfaces);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(warnings[0].where, "material 'Grey'");
    EXPECT_NE(warnings[0].fault.find("40 triangles"), std::string::npos) << warnings[0].fault;
    EXPECT_NE(warnings[1].fault.find("open at 8 edges"), std::string::npos) << warnings[1].fault;
}

TEST(OrientBodies, SheetsHaveNoInsideAndStay) {
    const OrientedBodies bodies =
        orient_bodies(wax({tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 3)}));
    EXPECT_FALSE(bodies.scene);
    EXPECT_EQ(bodies.surfaces[0].open_edges, 12u);
}

TEST(OrientBodies, OpaqueThingsAreNoneOfItsBusiness) {
    Primitive opaque = turned_inside_out(tests::make_sphere(1));
    opaque.material = 1;
    const OrientedBodies bodies = orient_bodies(wax({tests::make_sphere(1), opaque}));
    EXPECT_FALSE(bodies.scene);
    EXPECT_EQ(bodies.surfaces.size(), 1u);
}

TEST(OrientBodies, NonManifoldAndOneSidedSurfacesAreHarmless) {
    // Two cubes that share a side's edge, and a strip glued to itself the wrong way round.
    Primitive other = tests::make_cube(1, false);
    for (glm::vec3& p : other.position) {
        p += glm::vec3(2, 2, 0);
    }
    EXPECT_FALSE(orient_bodies(wax({tests::make_cube(1, false), other})).scene);
    Primitive moebius;
    moebius.position = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {0.5f, 1, 0}, {0.5f, 1, 1}};
    moebius.normal.assign(6, {0, 1, 0});
    moebius.index = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5, 4, 5, 1, 1, 5, 0};
    EXPECT_EQ(orient_bodies(wax({moebius})).surfaces[0].open_edges, 6u);
    Primitive nothing;
    nothing.position.assign(3, glm::vec3(1));
    nothing.normal.assign(3, glm::vec3(0));
    nothing.index = {0, 1, 2, 0, 0, 0};
    EXPECT_TRUE(orient_bodies(wax({nothing})).surfaces.empty());
}

Scene double_sided(std::vector<Primitive> primitives) {
    Scene scene = tests::make_scene(std::move(primitives));
    scene.materials[0].double_sided = true;
    return scene;
}

bool is_lit_on_both_sides(const OrientedBodies& bodies) {
    return bodies.scene && bodies.scene->materials[0].sheet;
}

TEST(OrientBodies, ADoubleSidedBodyTurnedInsideOutShowsItsOutside) {
    const Primitive right = tests::make_sphere(2);
    const OrientedBodies bodies = orient_bodies(double_sided({turned_inside_out(right)}));
    ASSERT_TRUE(bodies.scene);
    EXPECT_TRUE(same_triangles(bodies.scene->primitives[0], right));
    EXPECT_EQ(bodies.scene->primitives[0].normal, right.normal);
    EXPECT_FALSE(is_lit_on_both_sides(bodies));
    EXPECT_TRUE(bodies.surfaces.empty()) << "nothing to warn of";
}

// As Blender writes everything. What ends in them is hidden then (trace/hidden_receivers.h).
TEST(OrientBodies, ClosedDoubleSidedBodiesHaveOneSideAlsoWhereOneEndsInAnother) {
    const Primitive top = tests::make_cube(1, false);
    const Primitive leg = tests::transformed(top, glm::mat3(1), 0.4f, {0, -1, 0});
    for (const Scene& scene : {double_sided({top}), double_sided({top, leg})}) {
        const OrientedBodies bodies = orient_bodies(scene);
        ASSERT_TRUE(bodies.scene);
        EXPECT_FALSE(bodies.scene->materials[0].double_sided);
        EXPECT_FALSE(is_lit_on_both_sides(bodies));
    }
}

TEST(OrientBodies, DoubleSidedWallsAndRoomsThatAreLivedInHaveLightOnBothSides) {
    const Primitive wall = tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const OrientedBodies open = orient_bodies(double_sided({wall}));
    ASSERT_TRUE(is_lit_on_both_sides(open));
    EXPECT_EQ(open.scene->materials[0].sheet->reflect, (formats::Rgb{1, 1, 1}));
    EXPECT_EQ(open.scene->materials[0].sheet->transmit, formats::Rgb{});
    const Primitive room = tests::make_cube(1, true);
    EXPECT_FALSE(is_lit_on_both_sides(orient_bodies(double_sided({room}))));
    EXPECT_TRUE(
        is_lit_on_both_sides(orient_bodies(double_sided({room, tests::make_sphere(1, 0.2f)}))));
    Scene lit = double_sided({room});
    lit.lights.emplace_back();
    EXPECT_TRUE(is_lit_on_both_sides(orient_bodies(lit)));
    Scene leaves = double_sided({tests::make_sphere(1)});
    leaves.materials[0].alpha_mode = formats::Material::AlphaMode::mask;
    EXPECT_TRUE(is_lit_on_both_sides(orient_bodies(leaves))) << "its inside is seen through holes";
}

// As programs write the seam of a sphere: sin(2 pi) is not 0.
TEST(OrientBodies, SeamsThatOnlyRoundingOpensAreClosed) {
    for (const glm::vec3 place : {glm::vec3(0), glm::vec3(300, -7, 20)}) {
        Primitive ball = tests::make_cube(2, false);
        std::uint32_t i = 0;
        for (glm::vec3& at : ball.position) {
            const float off = i++ % 2 == 0 ? 1.2e-7f : -1e-16f;
            at = place + at + off;
        }
        const OrientedBodies bodies = orient_bodies(wax({ball}));
        EXPECT_EQ(bodies.surfaces[0].open_edges, 0u) << place.x;
        EXPECT_TRUE(describe_faults(wax({}), bodies.surfaces).empty());
    }
    Primitive gap = tests::make_cube(1, false);
    gap.position[0] += 1e-4f;
    EXPECT_GT(orient_bodies(wax({gap})).surfaces[0].open_edges, 0u) << "a hole that one can see";
}

}  // namespace
}  // namespace opaline::bake
