#include "bake/exchange/bounce_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/check/check_model.h"
#include "bake/effects/interreflection/interreflection.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

const std::vector<std::string> kWith{"direct", "interreflection"};

BakeOptions with_rays(double rays) {
    BakeOptions options = tests::bounce_options(kWith);
    options.set(kBounceRays, rays);
    return options;
}

// White surfaces under white light, all paths of which end in the sky: radiance 1 everywhere, even
// in the crack between ball and floor, after any number of bounces.
TEST(BounceLight, WhiteFurnaceOfABallOverAFloor) {
    const BakeResult baked = tests::bake_scene(tests::make_dented_ball(), with_rays(256));
    double squares = 0, mean = 0;
    const auto radiance = tests::relight(baked.asset.view(), "white");
    for (const formats::Rgb& c : radiance) {
        const double error = static_cast<double>(c.g) - 1;
        squares += error * error / static_cast<double>(radiance.size());
        mean += error / static_cast<double>(radiance.size());
        EXPECT_NEAR(error, 0, 0.1);
    }
    EXPECT_LT(std::sqrt(squares), 0.016);
    EXPECT_LT(std::abs(mean), 0.004);
}

// A ball over its floor against path tracing, all orders of reflection. The bound on the RMS is
// that of few receivers, some of them deep in dents, and the reference's noise.
TEST(BounceLight, AgreesWithPathTracing) {
    formats::Scene ball = tests::make_dented_ball();
    ball.materials[0].base_color = {0.7f, 0.7f, 0.7f};
    const BakeResult baked = tests::bake_scene(ball, with_rays(144));
    ModelCheckOptions wanted;
    wanted.simulated = held_light(all_effects(), baked.plan);
    wanted.receivers = 48;
    wanted.noise = 0.03;
    wanted.noise_share = 1;
    const auto report = check_model(ball, baked.asset.view(), wanted, {}).value();
    for (const ModelErrorReport::Part& light : report.by_light) {
        if (light.name == "white" || light.name == "studio") {
            EXPECT_LT(light.rms_relative, 0.06) << light.name;
            EXPECT_LT(std::abs(light.bias), 0.02) << light.name;
            EXPECT_LT(light.missing, 1e-3) << "nothing is left out";
        }
    }
}

// A red floor lights the lower half of a white ball, and the ball's file has three bands.
TEST(BounceLight, ColourBleeds) {
    formats::Scene scene = tests::make_dented_ball();
    scene.materials.push_back({.name = "Floor", .base_color = {0.8f, 0.1f, 0.1f}});
    scene.primitives[1].material = 1;
    const BakeResult baked = tests::bake_scene(scene, with_rays(64));
    EXPECT_EQ(baked.asset.primitives[0].bands, 3u);
    const auto radiance = tests::relight(baked.asset.view(), "sky:3,60");
    const auto plain = tests::relight(
        tests::bake_scene(scene, tests::bounce_options({"direct"})).asset.view(), "sky:3,60");
    double red = 0, blue = 0;
    for (std::size_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        if (scene.primitives[0].normal[v].y < -0.5f) {
            red += radiance[v].r - plain[v].r;
            blue += radiance[v].b - plain[v].b;
        }
    }
    EXPECT_GT(red, 4 * blue);
    EXPECT_GT(blue, 0);
}

}  // namespace
}  // namespace opaline::bake
