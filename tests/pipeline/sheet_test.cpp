// Thin-walled surfaces in whole bakes: both sides, against closed forms and path tracing.

#include <gtest/gtest.h>

#include <numbers>

#include "bake/accuracy/check_model.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

tests::Scene make_sheet_scene(std::vector<tests::Primitive> primitives, Rgb reflect, Rgb transmit) {
    tests::Scene scene = tests::make_scene(std::move(primitives));
    scene.materials[0].sheet = formats::Sheet{reflect, transmit};
    scene.materials[0].double_sided = true;
    scene.materials.push_back({.name = "Opaque"});
    return scene;
}

// Facing up.
tests::Primitive make_leaf() {
    return tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4);
}

std::vector<Rgb> seen_from(const formats::Asset& asset, formats::Vec3 eye, const char* light) {
    return tests::relight_primitive(asset, light, 0, {.eye = eye});
}

TEST(Sheet, UnderEvenLightShowsWhatItReflectsAndTransmitsFromBothSides) {
    const BakeResult baked = tests::bake_scene(
        make_sheet_scene({make_leaf()}, {0.2f, 0.5f, 0}, {0.3f, 0.5f, 0.1f}), tests::small_bake());
    for (const float height : {3.0f, -3.0f}) {
        for (const Rgb c : seen_from(baked.asset, {0, height, 0}, "white")) {
            EXPECT_NEAR(c.r, 0.5f, 0.01f);
            EXPECT_NEAR(c.g, 1.0f, 0.01f);
            EXPECT_NEAR(c.b, 0.1f, 0.01f);
        }
    }
}

// A sun of irradiance pi at elevation 30 degrees: L = share sin 30.
TEST(Sheet, UnderASunReflectsOnItsSideAndTransmitsOnTheOther) {
    constexpr float kReflect = 0.2f, kTransmit = 0.6f;
    BakeOptions options = tests::small_bake();
    options.cubemap_size = 32;
    const BakeResult baked =
        tests::bake_scene(make_sheet_scene({make_leaf()}, {kReflect, kReflect, kReflect},
                                           {kTransmit, kTransmit, kTransmit}),
                          options);
    EXPECT_EQ(baked.asset.primitives[0].bands, 1u);
    EXPECT_EQ(baked.asset.primitives[0].terms, 2u);
    const auto mean_from = [&](float height) {
        double sum = 0;
        const auto seen = seen_from(baked.asset, {0, height, 0}, "sun:40,30");
        for (const Rgb c : seen) {
            sum += static_cast<double>(c.g) / static_cast<double>(seen.size());
        }
        return sum;
    };
    const double sun = mean_from(3) / static_cast<double>(kReflect);
    EXPECT_NEAR(mean_from(-3), sun * static_cast<double>(kTransmit), 0.02 * sun)
        << "codes of 8 bits";
    // The same sun on an opaque surface.
    tests::Scene opaque = tests::make_scene({make_leaf()});
    const BakeResult plain = tests::bake_scene(opaque, options);
    const Rgb lit = tests::relight_primitive(plain.asset, "sun:40,30").front();
    EXPECT_NEAR(sun, static_cast<double>(lit.g), 0.03 * sun);
}

// Curved, self-shadowing, above a floor that shadows its lower side; coloured.
TEST(Sheet, IsAsBrightAsPathTracedFromAboveAndFromBelow) {
    tests::Primitive bowl = tests::make_sphere(3, 1, {0, 1.2f, 0});
    bowl.index.resize(bowl.index.size() / 2);
    for (const bool turned : {false, true}) {
        tests::Primitive floor = tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 6);
        floor.material = 1;
        const tests::Scene scene =
            make_sheet_scene({turned ? tests::turned_inside_out(bowl) : bowl, floor},
                             {0.1f, 0.3f, 0.05f}, {0.2f, 0.6f, 0.1f});
        BakeOptions options = tests::small_bake();
        options.cubemap_size = 32;
        options.separate_terms = turned;
        const BakeResult baked = tests::bake_scene(scene, options);
        ModelCheckOptions check;
        check.max_events = 2000000;
        const auto report = check_model(scene, baked.asset.view(), check, {});
        ASSERT_TRUE(report);
        EXPECT_LT(report->by_light[0].rms_relative, 0.02) << turned;
        EXPECT_LT(std::abs(report->by_light[0].bias), 0.01) << turned;
        EXPECT_LT(baked.error.at_receivers.rms_relative, 0.08);
    }
}

TEST(Sheet, CostsNothingWhereThereIsNone) {
    const tests::Scene plain = tests::make_scene({make_leaf()});
    for (const PlanEntry& entry : plan_bake(all_effects(), plain, inspect_scene(plain), {})) {
        EXPECT_NE(entry.name, "sheet");
    }
    const tests::Scene sheet = make_sheet_scene({make_leaf()}, {0.5f, 0.5f, 0.5f}, {});
    for (const PlanEntry& entry : plan_bake(all_effects(), sheet, inspect_scene(sheet), {})) {
        EXPECT_NE(entry.name, "direct") << "its rows by side hold it";
    }
    EXPECT_TRUE(
        find_entry(plan_bake(all_effects(), sheet, inspect_scene(sheet), {}), "sheet", 0)->on);
    const tests::Scene black = make_sheet_scene({make_leaf()}, {}, {});
    const BakeResult baked = tests::bake_scene(black, tests::small_bake());
    EXPECT_FALSE(find_entry(baked.plan, "sheet", 0)->on);
    EXPECT_EQ(tests::relight_primitive(baked.asset, "white").front(), Rgb{});
}

TEST(Sheet, BytesDoNotDependOnTheNumberOfThreads) {
    const tests::Scene scene =
        make_sheet_scene({tests::make_sphere(3)}, {0.1f, 0.3f, 0}, {0.2f, 0.1f, 0.5f});
    BakeOptions one = tests::small_bake(), three = one;
    one.threads = 1;
    three.threads = 3;
    EXPECT_EQ(tests::largest_difference(tests::bake_scene(scene, one).asset,
                                        tests::bake_scene(scene, three).asset, "studio",
                                        {.eye = formats::Vec3{4, 2, 1}}),
              0);
}

// No triangle area, no normal, a fold back onto itself.
TEST(Sheet, HardCasesAreFiniteAndNoBrighterThanTheSky) {
    tests::Primitive sliver = make_leaf();
    for (glm::vec3& p : sliver.position) {
        p.x *= 1e-6f;
    }
    tests::Primitive bare = make_leaf();
    bare.normal.assign(bare.normal.size(), glm::vec3(0));
    tests::Primitive twice = make_leaf();
    for (const auto& body : std::vector<std::vector<tests::Primitive>>{
             {sliver}, {bare}, {twice, tests::turned_inside_out(twice)}}) {
        const BakeResult baked = tests::bake_scene(
            make_sheet_scene(body, {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}), tests::small_bake());
        EXPECT_TRUE(tests::all_finite(baked.asset));
        for (const Rgb c : seen_from(baked.asset, {0, -3, 0}, "white")) {
            EXPECT_TRUE(c.g >= 0 && c.g < 1.05f) << c.g;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
