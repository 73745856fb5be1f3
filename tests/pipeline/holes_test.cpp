// Surfaces that light passes: alphaMode of a glTF file.
#include <gtest/gtest.h>

#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// A floor under a plate that covers half of its sky.
formats::Scene floor_under_plate(formats::Material::AlphaMode mode, float alpha) {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2),
                           tests::make_quad({-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, 1)});
    scene.primitives[1].material = 1;
    scene.materials.push_back({.name = "Plate", .alpha_mode = mode, .alpha = alpha});
    return scene;
}

double floor_light(const formats::Scene& scene) {
    double sum = 0;
    for (const formats::Rgb& c :
         tests::relight_primitive(tests::bake_scene(scene, tests::small_bake()).asset, "white")) {
        sum += static_cast<double>(c.g);
    }
    return sum / static_cast<double>(scene.primitives[0].position.size());
}

TEST(Holes, OfAMaskLetAllLightPassAndThoseOfABlendTheirShare) {
    using enum formats::Material::AlphaMode;
    formats::Scene open = floor_under_plate(opaque, 1);
    open.primitives.pop_back();
    const double bare = floor_light(open), covered = floor_light(floor_under_plate(opaque, 1));
    EXPECT_LT(covered, 0.8 * bare);
    EXPECT_DOUBLE_EQ(floor_light(floor_under_plate(mask, 0.4f)), bare);
    EXPECT_DOUBLE_EQ(floor_light(floor_under_plate(mask, 0.6f)), covered);
    EXPECT_NEAR(floor_light(floor_under_plate(blend, 0.3f)), 0.7 * bare + 0.3 * covered,
                0.03 * bare);
}

// A white floor and a pane that absorbs nothing, under even light: what the pane keeps off the
// floor it mirrors back to it.
TEST(Holes, OfAWindowLetInWhatItsFacesDoNotMirror) {
    using enum formats::Material::AlphaMode;
    formats::Scene scene = floor_under_plate(opaque, 1);
    const double covered = floor_light(scene);
    scene.materials[0].base_color = scene.materials[1].base_color = {0, 0, 0};
    scene.materials[0].base_color = {0.2f, 0.2f, 0.2f};
    const double dark = floor_light(scene);
    scene.materials[1].sheet = formats::Sheet{.clear = 1};
    const double glazed = floor_light(scene);
    scene.primitives.pop_back();
    const double open = floor_light(scene);
    EXPECT_GT(covered, 0);
    EXPECT_LT(dark, 0.7 * open);
    // 0.83 of even light, 0.92 of what comes straight from above.
    EXPECT_TRUE(glazed > open - 0.2 * (open - dark) && glazed < open - 0.07 * (open - dark))
        << dark << " " << glazed << " " << open;
}

TEST(Holes, AreKeptInTheFileAndChangeNothingForWholeSurfaces) {
    using enum formats::Material::AlphaMode;
    const auto record_of = [](const formats::Scene& scene) {
        return tests::bake_scene(scene, tests::small_bake()).asset.holes.record;
    };
    const auto holes = record_of(floor_under_plate(mask, 0.4f));
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_EQ(holes[0].primitive, 1u);
    EXPECT_EQ(holes[0].alpha, 0.4f);
    EXPECT_TRUE(record_of(floor_under_plate(opaque, 0.4f)).empty());
}

}  // namespace
}  // namespace opaline::bake
