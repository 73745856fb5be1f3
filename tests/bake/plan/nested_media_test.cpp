// Which media lie inside which, and how deep.

#include <gtest/gtest.h>

#include "bake/scene/inspect_scene.h"
#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/touching_bodies.h"

namespace opaline::tests {
namespace {

formats::Medium coat() {
    return make_grey_medium(4, 1);
}

formats::Medium core() {
    return make_grey_medium(9, 1, 1.5f);
}

std::vector<bake::MaterialFacts> inspect(std::vector<Part> parts) {
    return bake::inspect_scene(make_nested_scene(std::move(parts))).material;
}

TEST(NestedMedia, CoreInACoatIsFoundWithALowerBoundOfItsDepthThatIsAtLeastHalfOfIt) {
    for (const float radius : {0.3f, 0.9f, 0.98f}) {
        const auto facts = inspect({{make_sphere(3), coat()}, {make_sphere(2, radius), core()}});
        ASSERT_EQ(facts[0].inner.size(), 1u) << radius;
        EXPECT_EQ(facts[0].inner[0].material, 1u);
        EXPECT_EQ(facts[0].inner[0].medium.eta, 1.5f);
        // Facets of the outer ball are up to 0.5 % of its radius below it.
        EXPECT_LE(facts[0].inner[0].depth, 1 - static_cast<double>(radius));
        EXPECT_GE(facts[0].inner[0].depth, 0.5 * (0.99 - static_cast<double>(radius)) - 1e-6);
        EXPECT_TRUE(facts[1].is_buried);
        EXPECT_FALSE(facts[0].is_buried);
        EXPECT_TRUE(facts[1].inner.empty());
    }
}

TEST(NestedMedia, BodiesBesideEachOtherContainNothing) {
    for (const float distance : {1.6f, 2.0f, 3.0f}) {  // boxes overlap, or touch, or do not
        const glm::vec3 centre = distance / std::sqrt(2.0f) * glm::vec3(1, 1, 0) * 1.3f;
        const auto facts = inspect({{make_sphere(3), coat()}, {make_sphere(3, 1, centre), core()}});
        EXPECT_TRUE(facts[0].inner.empty() && facts[1].inner.empty()) << distance;
        EXPECT_FALSE(facts[0].is_buried || facts[1].is_buried) << distance;
    }
}

// Light goes on from one into the other: a face in common, and a third body on the second.
TEST(NestedMedia, BodiesThatTouchHaveEachOtherAtNoDepthAndAllThatTheOthersTouch) {
    const auto cube_at = [](glm::vec3 at) {
        Primitive cube = make_cube(2, false);
        for (glm::vec3& p : cube.position) {
            p += at;
        }
        return cube;
    };
    const auto facts = inspect({{cube_at({0, 0, 0}), coat()},
                                {cube_at({2, 0, 0}), core()},
                                {cube_at({4, 0.3f, 0}), coat()},
                                {cube_at({0, 2.001f, 0}), core()}});
    for (std::uint32_t m = 0; m < 3; ++m) {
        ASSERT_EQ(facts[m].inner.size(), 2u) << m;
        EXPECT_EQ(facts[m].inner[0].depth, 0);
        EXPECT_FALSE(facts[m].is_buried);
    }
    EXPECT_EQ(facts[0].inner[0].material, 1u);
    EXPECT_EQ(facts[0].inner[1].material, 2u);
    EXPECT_TRUE(facts[3].inner.empty()) << "a gap";
}

// The dipole takes faces for surface that lie in other bodies or against them.
TEST(NestedMedia, BodiesOfOneMediumThatOverlapOrTouchAreFoundAndShellsOfHollowOnesAreNone) {
    const auto overlap = [](const Primitive& a, const Primitive& b) {
        Scene scene = make_nested_scene({{a, coat()}, {b, coat()}});
        scene.primitives[1].material = 0;
        return bake::inspect_scene(scene).material[0].overlaps;
    };
    const Primitive box = make_box({0, 0, 0}, {1, 1, 1}, 4);
    EXPECT_TRUE(overlap(box, make_box({0.5f, 0, 0}, {1.5f, 1, 1}, 4))) << "faces in one plane";
    EXPECT_TRUE(overlap(make_sphere(3), make_sphere(3, 1, {1, 0.5f, 0})));
    EXPECT_TRUE(overlap(box, make_box({1, 0, 0}, {2, 1, 1}, 4))) << "they touch";
    EXPECT_FALSE(overlap(box, make_box({1.1f, 0, 0}, {2, 1, 1}, 4)));
    EXPECT_FALSE(overlap(make_sphere(3), turned_inside_out(make_sphere(3, 0.6f))));
}

TEST(NestedMedia, ABodyInACavityOfAnotherIsNotInIt) {
    Scene scene = make_nested_scene({{make_sphere(3), coat()}, {make_sphere(3, 0.3f), core()}});
    Primitive cavity = turned_inside_out(make_sphere(3, 0.6f));
    cavity.material = 0;
    scene.primitives.push_back(cavity);
    const auto facts = bake::inspect_scene(scene).material;
    EXPECT_TRUE(facts[0].inner.empty());
    EXPECT_FALSE(facts[1].is_buried);
}

TEST(NestedMedia, OverlappingBodiesContainEachOtherAtNoDepthAndBothAreSeen) {
    const auto facts =
        inspect({{make_sphere(3), coat()}, {make_sphere(3, 0.5f, {0.9f, 0, 0}), core()}});
    ASSERT_EQ(facts[0].inner.size(), 1u);
    EXPECT_EQ(facts[0].inner[0].depth, 0);
    ASSERT_EQ(facts[1].inner.size(), 1u);
    EXPECT_FALSE(facts[0].is_buried || facts[1].is_buried);
}

TEST(NestedMedia, HolesDoNotHideWhatLiesInside) {
    Primitive holed = make_sphere(3);
    holed.index.resize(holed.index.size() - 30);
    const auto facts = inspect({{holed, coat()}, {make_sphere(3, 0.5f), core()}});
    EXPECT_EQ(facts[0].inner.size(), 1u);
}

TEST(NestedMedia, EveryMediumOfAChainContainsAllThatFollow) {
    const auto facts = inspect(
        {{make_sphere(3), coat()}, {make_sphere(3, 0.7f), core()}, {make_sphere(3, 0.4f), coat()}});
    EXPECT_EQ(facts[0].inner.size(), 2u);
    EXPECT_EQ(facts[1].inner.size(), 1u);
    EXPECT_TRUE(facts[1].is_buried && facts[2].is_buried);
}

TEST(NestedMedia, ABodyIsGreyOnlyIfAllMediaInsideAre) {
    formats::Medium red = core();
    red.sigma_a.r = 0;
    EXPECT_TRUE(inspect({{make_sphere(2), coat()}, {make_sphere(2, 0.5f), core()}})[0].is_grey);
    EXPECT_FALSE(inspect({{make_sphere(2), coat()}, {make_sphere(2, 0.5f), red}})[0].is_grey);
    EXPECT_TRUE(
        inspect({{make_sphere(2), coat()}, {make_sphere(2, 0.5f, {3, 0, 0}), red}})[0].is_grey);
}

TEST(NestedMedia, ManyPartsThatTouchAreInspectedInBoundedTime) {
    std::vector<Part> parts;
    parts.reserve(12);
    for (int i = 0; i < 12; ++i) {
        parts.push_back({make_sphere(4, 1 - 1e-5f * static_cast<float>(i)), coat()});
    }
    const auto facts = inspect(std::move(parts));
    EXPECT_FALSE(facts[0].inner.empty());
}

}  // namespace
}  // namespace opaline::tests
