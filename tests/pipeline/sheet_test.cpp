// Thin-walled surfaces in whole bakes: both sides, against closed forms and path tracing.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/check/check_model.h"
#include "bake/reference/estimate.h"
#include "bake/reference/random_stream.h"
#include "bake/scene/flatten_slabs.h"
#include "bake/scene/inspect_scene.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"

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
        options.effects = {"direct", "sheet"};
        const BakeResult baked = tests::bake_scene(scene, options);
        ModelCheckOptions check;
        check.max_events = 700000;
        const auto report = check_model(scene, baked.asset.view(), check, {});
        ASSERT_TRUE(report);
        EXPECT_LT(report->by_light[0].rms_relative, 0.02) << turned;
        EXPECT_LT(std::abs(report->by_light[0].bias), 0.01) << turned;
        EXPECT_LT(baked.error.at_receivers.rms_relative, 0.08);
    }
}

// All light comes from above, so that the front of a leaf shows none that it transmits.
TEST(Sheet, ThatTransmitsTooMuchIsFoundByTheModelCheckFromBehind) {
    const BakeResult baked =
        tests::bake_scene(make_sheet_scene({make_leaf()}, {0.2f, 0.2f, 0.2f}, {0.6f, 0.6f, 0.6f}),
                          tests::small_bake());
    const tests::Scene darker =
        make_sheet_scene({make_leaf()}, {0.2f, 0.2f, 0.2f}, {0.3f, 0.3f, 0.3f});
    ModelCheckOptions check;
    check.max_events = 100000;
    const auto report = check_model(darker, baked.asset.view(), check, {});
    ASSERT_TRUE(report);
    const auto sun =
        std::ranges::find(report->by_light, "sun:30,60", &ModelErrorReport::Part::name);
    ASSERT_NE(sun, report->by_light.end());
    // sqrt(mean of (0, 0.3)^2 / mean of (0.2, 0.3)^2)
    EXPECT_NEAR(sun->rms_relative, 0.83, 0.1);
}

// Under even light, the mean over views of a real slab of index 1, far from its rim.
TEST(Sheet, OfAMediumIsAsBrightAsAPathTracedSlabInTheMean) {
    formats::Medium medium = tests::make_grey_medium(300, 30, 1);
    medium.thickness = 0.01f;  // three mean free paths
    tests::Scene scene = tests::make_scene({make_leaf()});
    scene.materials[0].medium = medium;
    EXPECT_TRUE(flatten_slabs(scene).empty());
    ASSERT_FALSE(scene.materials[0].medium);
    ASSERT_TRUE(scene.materials[0].sheet);
    EXPECT_TRUE(scene.materials[0].double_sided);
    const formats::Sheet sheet = *scene.materials[0].sheet;
    EXPECT_EQ(sheet.reflect.r, sheet.reflect.b) << "the same walks";

    const tests::Scene slab = tests::make_translucent_scene(tests::make_sheet(0.01f, 8, 2), medium);
    const auto traced = make_reference_scene(slab, 0);
    ASSERT_TRUE(traced);
    const formats::Environment white = make_environment("white").value();
    const LightSampler light = make_light_sampler(white, glm::mat3(1.0f));
    PathOptions options;
    options.terms = TermSet::multiple | TermSet::single;
    Moments seen;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        RandomStream random(3, 0, i);
        // Cosine-distributed.
        const float u = random.next(), phi = 2 * std::numbers::pi_v<float> * random.next();
        const glm::vec3 to_eye(std::sqrt(u) * std::cos(phi), std::sqrt(1 - u),
                               std::sqrt(u) * std::sin(phi));
        seen.add(trace_ray({*traced, light, options}, 0.9f * to_eye, -to_eye, random, {}).radiance);
    }
    const double error = std::sqrt(seen.variance_of_mean().x);
    EXPECT_LT(error, 0.003);
    EXPECT_NEAR(static_cast<double>(sheet.reflect.g + sheet.transmit.g), seen.mean.x,
                4 * error + 0.004);
}

TEST(Sheet, OfAClearMediumWarnsOfWhatPassesUnscattered) {
    tests::Scene scene = tests::make_scene({make_leaf()});
    scene.materials[0].medium = tests::make_grey_medium(10, 0, 1);
    scene.materials[0].medium->thickness = 0.01f;
    EXPECT_THAT(flatten_slabs(scene),
                ::testing::ElementsAre(::testing::Field(&formats::Diagnostic::fault,
                                                        ::testing::HasSubstr("83 % of the light"))))
        << "2 E_3(0.1)";
}

// Index above 1: what does not enter is mirrored; the energy of both adds up.
TEST(Sheet, OfARefractingMediumIsGlossyAndLosesNothing) {
    tests::Scene scene = tests::make_scene({make_leaf()});
    scene.materials[0].medium = tests::make_grey_medium(1000, 0, 1.5f);
    scene.materials[0].medium->thickness = 0.02f;
    EXPECT_TRUE(flatten_slabs(scene).empty());
    const formats::Sheet sheet = *scene.materials[0].sheet;
    EXPECT_NEAR(sheet.reflect.g + sheet.transmit.g, 1, 0.01f);
    EXPECT_GT(sheet.reflect.g, 5 * sheet.transmit.g);
    EXPECT_EQ(scene.materials[0].gloss.ior, 1.5f);
    const BakeResult baked = tests::bake_scene(scene, tests::small_bake());
    EXPECT_TRUE(find_entry(baked.plan, "gloss", 0)->on);
}

// A sun of irradiance pi at elevation 30 degrees lights a wall from above alone.
TEST(Sheet, ADoubleSidedOpaqueWallShowsOnEachSideTheLightThatFallsThere) {
    tests::Scene scene = tests::make_scene({make_leaf()});
    scene.materials[0].double_sided = true;
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    for (const bool turned : {false, true}) {
        if (turned) scene.primitives[0] = tests::turned_inside_out(scene.primitives[0]);
        BakeOptions options = tests::small_bake();
        options.effects = {"direct"};
        const BakeResult baked = tests::bake_scene(scene, options);
        EXPECT_TRUE(find_entry(baked.plan, "direct", 0)->on);
        for (const Rgb c : seen_from(baked.asset, {0, 3, 0}, "sun:40,30")) {
            EXPECT_NEAR(c.g, 0.25f, 0.1f) << turned;
        }
        for (const Rgb c : seen_from(baked.asset, {0, -3, 0}, "sun:40,30")) {
            EXPECT_NEAR(c.g, 0, 0.02f) << turned;
        }
    }
}

// What is seen of one from behind is what is seen of it in front, turned inside out: with all that
// stands before its light.
TEST(Sheet, SeenFromBehindIsAsTurnedInsideOutSeenInFront) {
    tests::Primitive bowl = tests::make_sphere(2, 1, {0, 1.2f, 0});
    bowl.index.resize(bowl.index.size() / 2);
    const auto bake_of = [](const tests::Primitive& body) {
        tests::Primitive floor = tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 6);
        floor.material = 1;
        BakeOptions options = tests::small_bake();
        options.cubemap_size = 16;
        return tests::bake_scene(
            make_sheet_scene({body, floor}, {0.1f, 0.3f, 0.05f}, {0.2f, 0.6f, 0.1f}), options);
    };
    const BakeResult front = bake_of(bowl), turned = bake_of(tests::turned_inside_out(bowl));
    const formats::Vec3 eye{0.3f, 4, 0.2f};
    for (const char* light : {"studio", "sun:40,30"}) {
        const auto a = seen_from(front.asset, eye, light), b = seen_from(turned.asset, eye, light);
        EXPECT_LT(tests::relative_rms(a, b), 0.02) << light;
        double sum = 0;
        for (const Rgb c : a) {
            sum += static_cast<double>(c.g) / static_cast<double>(a.size());
        }
        EXPECT_GT(sum, 0.05) << light;
    }
}

// Two of its vertices stand inside a box, where nothing is lit: both of their sides borrow from
// where the sheet comes out of it.
TEST(Sheet, VerticesInsideABoxAreBlackOnNeitherSide) {
    tests::Primitive box = tests::make_cube(2, false);
    box.material = 1;
    tests::Primitive sheet = tests::make_quad({-0.5f, 0.9f, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    for (const Rgb share : {Rgb{1, 1, 1}, Rgb{0, 0, 0}}) {
        const Rgb rest{1 - share.r, 1 - share.g, 1 - share.b};
        const BakeResult baked =
            tests::bake_scene(make_sheet_scene({sheet, box}, share, rest), tests::small_bake());
        for (const float z : {9.0f, -9.0f}) {
            for (const Rgb c : seen_from(baked.asset, {0, 1, z}, "white")) {
                EXPECT_GT(c.g, 0.3f) << share.g << " " << z;
            }
        }
    }
}

TEST(Sheet, OfAMediumThatTakesLongWalksEndsSoonAndLosesNothing) {
    for (const float eta : {0.75f, 1.0f, 1.5f}) {
        tests::Scene scene = tests::make_scene({make_leaf()});
        formats::Medium medium = tests::make_grey_medium(1e7f, 0, eta);
        medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = 0.99f;
        medium.thickness = 1;
        scene.materials[0].medium = medium;
        EXPECT_TRUE(flatten_slabs(scene).empty());
        const formats::Sheet sheet = *scene.materials[0].sheet;
        EXPECT_NEAR(sheet.reflect.g + sheet.transmit.g, 1, 0.02f) << eta;
        EXPECT_LT(sheet.transmit.g, 0.05f) << eta;
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
        float most = 0;
        for (const Rgb c : seen_from(baked.asset, {0, -3, 0}, "white")) {
            EXPECT_TRUE(c.g >= 0 && c.g < 1.05f) << c.g;
            most = std::max(most, c.g);
        }
        const bool has_normals = body[0].normal[0] != glm::vec3(0);
        EXPECT_EQ(most > 0.4f, has_normals);
    }
}

}  // namespace
}  // namespace opaline::bake
