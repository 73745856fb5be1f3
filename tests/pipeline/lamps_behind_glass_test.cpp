// Lamps, and what they light, seen through clear bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/transmission/rules_transmission.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

BakeOptions seen_straight(double terms) {
    BakeOptions options;
    options.quality = Quality::draft;
    options.threads = 1;
    options.effects = {"direct", "transmission", "emitters"};
    options.set(kEmitterParticles, 5000);
    options.set(kStraightTerms, terms);
    options.set(kStraightViews, 128);
    return options;
}

formats::Material glass(float sigma_a, float eta) {
    formats::Material material{.name = "Glass"};
    material.medium = tests::make_grey_medium(0, sigma_a, eta);
    return material;
}

std::vector<Rgb> show(const BakeResult& baked, const char* light, bool lamps) {
    std::vector<Rgb> radiance(baked.asset.position.size());
    runtime::ShadeOptions options;
    options.emitters = lamps ? runtime::EmitterLight{} : runtime::dark_emitters();
    runtime::shade(baked.asset.view(), tests::make_light(light, baked.knobs.cubemap_size), radiance,
                   options);
    return radiance;
}

tests::Primitive turned_inward(tests::Primitive shell) {
    for (std::size_t i = 0; i + 2 < shell.index.size(); i += 3) {
        std::swap(shell.index[i], shell.index[i + 1]);
    }
    for (glm::vec3& n : shell.normal) {
        n = -n;
    }
    return shell;
}

// A ball of glass of radius 0.5 in a cube of edge 2 whose inside glows.
formats::Scene ball_in_glowing_walls(float albedo) {
    formats::Scene scene =
        tests::make_scene({tests::make_sphere(2, 0.5f), tests::make_cube(2, true)});
    scene.materials[0] = glass(0.3f, 1.5f);
    scene.materials.push_back({.name = "Walls", .base_color = {albedo, albedo, albedo}});
    scene.materials[1].emission = {1, 1, 1};
    scene.primitives[1].material = 1;
    scene.primitives[1].node = 1;
    return scene;
}

class LampsBehindGlass : public testing::TestWithParam<int> {};

// Walls of radiance 1 are a white sky, and twice as bright where they reflect half of their light.
TEST_P(LampsBehindGlass, GlowingWallsShowThroughABallAsAWhiteSkyDoes) {
    formats::Scene alone = tests::make_scene({tests::make_sphere(2, 0.5f)});
    alone.materials[0] = glass(0.3f, 1.5f);
    const auto sky = show(tests::bake_scene(alone, seen_straight(GetParam())), "white", false);
    for (const float albedo : {0.0f, 0.5f}) {
        const BakeResult lit =
            tests::bake_scene(ball_in_glowing_walls(albedo), seen_straight(GetParam()));
        const auto walls = show(lit, "black", true);
        double difference = 0, all = 0;
        for (std::size_t v = 0; v < sky.size(); ++v) {
            const float expected = sky[v].g / (1 - albedo);
            ASSERT_GT(expected, 0.5f);
            difference += std::pow(walls[v].g - expected, 2);
            all += expected * expected;
        }
        EXPECT_LT(std::sqrt(difference / all), albedo == 0 ? 0.02 : 0.06) << albedo;
    }
}

INSTANTIATE_TEST_SUITE_P(RowsByView, LampsBehindGlass, testing::Values(1, 4, 9));

// A bulb of radius r in the middle of a ball of radius R and index 1: of views spread by the
// cosine (r / R)^2 meet it, of which most go along the normal.
double seen_of_bulb(const formats::Scene& scene, std::size_t outer) {
    const BakeResult baked = tests::bake_scene(scene, seen_straight(1));
    const auto radiance = show(baked, "black", true);
    double mean = 0;
    for (std::size_t v = 0; v < outer; ++v) {
        mean += radiance[v].g / static_cast<double>(outer);
    }
    return mean;
}

formats::Scene bulb_in(std::vector<tests::Primitive> glass_shells, float sigma_a) {
    const auto bulb = static_cast<std::uint32_t>(glass_shells.size());
    glass_shells.push_back(tests::make_sphere(2, 0.1f));
    formats::Scene scene = tests::make_scene(std::move(glass_shells));
    scene.materials[0] = glass(sigma_a, 1);
    scene.materials.push_back({.name = "Bulb", .base_color = {0, 0, 0}});
    scene.materials[1].emission = {10, 10, 10};
    scene.primitives[bulb].material = 1;
    scene.primitives[bulb].node = 1;
    return scene;
}

TEST(LampsInGlass, ABulbInAGlobeShowsThroughIt) {
    const tests::Primitive outer = tests::make_sphere(2, 0.5f);
    const formats::Scene scene = bulb_in({outer, turned_inward(tests::make_sphere(2, 0.45f))}, 10);
    EXPECT_NEAR(seen_of_bulb(scene, outer.position.size()), 10 * 0.04 * std::exp(-0.5), 0.02);
}

TEST(LampsInGlass, ABulbInASolidBallShowsThroughIt) {
    const tests::Primitive outer = tests::make_sphere(2, 0.5f);
    EXPECT_NEAR(seen_of_bulb(bulb_in({outer}, 1), outer.position.size()),
                10 * 0.04 * std::exp(-0.4), 0.02);
}

// Of index 1.5 it is a lens in which the bulb looks 1.5 times as large, and is 1 / 1.5^2 as bright.
// What leaves it lights the floor as the bulb alone would, but for what is mirrored back.
TEST(LampsInGlass, ABulbInASolidBallOfGlassLightsTheFloorAndNoWarningSaysOtherwise) {
    const tests::Primitive outer = tests::make_sphere(2, 0.5f);
    tests::Primitive floor = tests::make_quad({-2, -0.6f, -2}, {0, 0, 4}, {4, 0, 0}, 8);
    const auto lit = [&](float eta) {
        formats::Scene scene = bulb_in({outer}, 1e-6f);
        scene.materials[0].medium->eta = eta;
        floor.material = static_cast<std::uint32_t>(scene.materials.size());
        floor.node = 2;
        scene.materials.push_back({.name = "Floor", .base_color = {0.1f, 0.1f, 0.1f}});
        scene.primitives.push_back(floor);
        BakeOptions options = seen_straight(1);
        options.set(kEmitterParticles, 10000);
        const BakeResult baked = tests::bake_scene(scene, options);
        for (const formats::Diagnostic& warning : baked.warnings) {
            EXPECT_EQ(warning.fault.find("inside of"), std::string::npos) << warning.fault;
        }
        const auto radiance = show(baked, "black", true);
        std::array<double, 2> mean{};
        for (std::size_t v = 0; v < outer.position.size(); ++v) {
            mean[0] += radiance[v].g / static_cast<double>(outer.position.size());
        }
        const std::size_t begin = radiance.size() - floor.position.size();
        for (std::size_t v = begin; v < radiance.size(); ++v) {
            mean[1] += radiance[v].g / static_cast<double>(floor.position.size());
        }
        return mean;
    };
    const auto alone = lit(1), glass = lit(1.5f);
    EXPECT_NEAR(alone[0], 0.4, 0.02);
    EXPECT_NEAR(glass[0], alone[0], 0.03);
    EXPECT_GT(alone[1], 0.002);
    EXPECT_NEAR(glass[1] / alone[1], 0.97, 0.1);
}

}  // namespace
}  // namespace opaline::bake
