#include "bake/plan/bake_plan.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

TEST(BakePlan, KnobsFollowTheQualityUnlessGiven) {
    BakeOptions options;
    options.quality = Quality::production;
    const auto preset = resolve_knobs(options);
    ASSERT_TRUE(preset);
    options.cubemap_size = 8;
    options.coefficients = 20;
    const auto given = resolve_knobs(options);
    ASSERT_TRUE(given);
    EXPECT_EQ(given->cubemap_size, 8u);
    EXPECT_EQ(given->coefficients, 20u);
    EXPECT_EQ(given->code_bits, preset->code_bits);
}

TEST(BakePlan, ImpossibleKnobsAreUsageErrors) {
    for (const std::uint32_t size : {1u, 7u, 24u, 256u}) {
        BakeOptions options;
        options.cubemap_size = size;
        const auto knobs = resolve_knobs(options);
        ASSERT_FALSE(knobs) << size;
        EXPECT_EQ(knobs.error().kind, formats::ErrorKind::usage);
    }
    BakeOptions options;
    options.coefficients = 6;
    EXPECT_FALSE(resolve_knobs(options));
}

TEST(BakePlan, MoreCoefficientsThanTexelsMeansAll) {
    BakeOptions options;
    options.cubemap_size = 8;
    options.coefficients = 384;
    ASSERT_TRUE(resolve_knobs(options));
    EXPECT_EQ(resolve_knobs(options)->coefficients, kAllCoefficients);
}

TEST(BakePlan, BlackSurfacesAreNotSimulated) {
    auto scene = tests::make_scene({tests::make_sphere(1), tests::make_sphere(1)});
    scene.materials.push_back({.name = "Black", .base_color = {0, 0, 0}});
    scene.primitives[1].material = 1;
    const auto plan = plan_bake(scene, {});
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_TRUE(plan[0].on);
    EXPECT_FALSE(plan[1].on);
    EXPECT_EQ(plan[1].bound, 0);
}

TEST(BakePlan, UnusedMaterialsAreNotMentioned) {
    auto scene = tests::make_scene({tests::make_sphere(1)});
    scene.materials.push_back({.name = "Unused"});
    EXPECT_EQ(plan_bake(scene, {}).size(), 1u);
}

}  // namespace
}  // namespace opaline::bake
