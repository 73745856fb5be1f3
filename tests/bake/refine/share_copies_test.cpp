#include "bake/refine/share_copies.h"

#include <gtest/gtest.h>

#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr double kError = 0.01;

ShareReport share(formats::Scene& scene, double error = kError, unsigned threads = 2) {
    Context context;
    context.threads = threads;
    const RayScene rays = RayScene::build(scene, 2).value();
    return share_copies(rays, {error, 0}, context, scene);
}

// Balls of radius 1 in a row along x.
formats::Scene make_row(std::size_t count, float spacing) {
    formats::Scene scene = tests::make_scene({tests::make_sphere(3)});
    for (std::size_t i = 1; i < count; ++i) {
        scene.primitives.emplace_back().copy = {0, {spacing * static_cast<float>(i), 0, 0}};
    }
    return scene;
}

TEST(ShareCopies, ThoseFarApartShareAllRows) {
    formats::Scene scene = make_row(20, 300);
    const ShareReport report = share(scene);
    EXPECT_EQ(report.given, 19u);
    EXPECT_EQ(report.shared, 19u);
    EXPECT_TRUE(report.apart.empty());
    EXPECT_LT(report.error, 0.003);
    for (std::size_t p = 1; p < scene.primitives.size(); ++p) {
        EXPECT_EQ(scene.primitives[p].copy.primitive, 0u);
    }
}

// Of a dense row the ends and their neighbours see other things than the middle, where each has one
// on either side.
TEST(ShareCopies, ThoseWithLikeNeighboursShareRowsThoughTheFirstHasOthers) {
    formats::Scene scene = make_row(40, 2.5f);
    const ShareReport report = share(scene, 0.05);
    EXPECT_GE(report.shared, 30u);
    EXPECT_GE(report.apart.size(), 2u);
    EXPECT_LE(report.error, 0.05);
    for (const CopiedMesh& mesh : report.apart) {
        EXPECT_TRUE(mesh.first < 6 || mesh.first > 34) << mesh.first;
    }
    const formats::CopyOf& middle = scene.primitives[20].copy;
    EXPECT_NE(middle.primitive, 0u);
    EXPECT_FLOAT_EQ(middle.offset.x, 2.5f * static_cast<float>(20 - middle.primitive));
    expand_copies(report.apart, scene);
    for (const formats::Primitive& p : scene.primitives) {
        EXPECT_FALSE(p.is_copy() && scene.primitives[p.copy.primitive].is_copy());
    }
}

// A floor of another colour under one of them hides as much.
TEST(ShareCopies, OneBesideAWallOrAboveAnotherFloorHasRowsOfItsOwn) {
    formats::Scene scene = make_row(5, 100);
    scene.materials.push_back({.name = "Red", .base_color = {0.8f, 0.1f, 0.1f}});
    for (std::size_t i = 0; i < 5; ++i) {
        const auto x = 100 * static_cast<float>(i);
        scene.primitives.push_back(tests::make_quad({x - 4, -1.5f, -4}, {0, 0, 8}, {8, 0, 0}));
        scene.primitives.back().material = i == 2 ? 1 : 0;
    }
    scene.primitives.push_back(tests::make_quad({398, -1, -3}, {0, 4, 0}, {0, 0, 6}));
    const ShareReport report = share(scene, 0.03);
    ASSERT_EQ(report.apart.size(), 2u);
    EXPECT_EQ(report.apart[0].first, 2u);
    EXPECT_EQ(report.apart[1].first, 4u);
    EXPECT_EQ(report.shared, 2u);
}

TEST(ShareCopies, LightOfPlacesAndMediaIsNotShared) {
    const auto shared_with = [](auto&& change) {
        formats::Scene scene = make_row(3, 300);
        change(scene);
        return share(scene).shared;
    };
    EXPECT_EQ(shared_with([](formats::Scene&) {}), 2u);
    EXPECT_EQ(shared_with([](formats::Scene& s) { s.lights.emplace_back(); }), 0u);
    EXPECT_EQ(shared_with([](formats::Scene& s) { s.materials[0].emission = {1, 1, 1}; }), 0u);
    EXPECT_EQ(shared_with([](formats::Scene& s) { s.materials[0].marble.emplace(); }), 0u);
    EXPECT_EQ(shared_with([](formats::Scene& s) { s.materials[0].sheet.emplace(); }), 0u);
    EXPECT_EQ(shared_with(
                  [](formats::Scene& s) { s.materials[0].medium = tests::make_grey_medium(1, 0); }),
              0u);
}

// Tiles side by side see the same sky. An edge that is halved on one side alone would be a crack.
TEST(ShareCopies, PartsThatShareVerticesHaveRowsOfTheirOwn) {
    const auto shared_at = [](float spacing) {
        formats::Scene scene =
            tests::make_scene({tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 2)});
        for (int i = 1; i < 4; ++i) {
            scene.primitives.emplace_back().copy = {0, {spacing * static_cast<float>(i), 0, 0}};
        }
        return share(scene).shared;
    };
    EXPECT_EQ(shared_at(1), 0u);
    EXPECT_EQ(shared_at(1.25f), 3u);
}

TEST(ShareCopies, AreTheSameForAnyNumberOfThreads) {
    formats::Scene one = make_row(40, 3), three = one;
    const ShareReport a = share(one, 0.03, 1), b = share(three, 0.03, 3);
    EXPECT_EQ(a.shared, b.shared);
    EXPECT_EQ(a.error, b.error);
    for (std::size_t p = 0; p < one.primitives.size(); ++p) {
        EXPECT_EQ(one.primitives[p].copy.primitive, three.primitives[p].copy.primitive);
    }
}

}  // namespace
}  // namespace opaline::bake
