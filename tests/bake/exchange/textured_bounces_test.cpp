#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/bake/exchange/textured_plates.h"

namespace opaline::bake {
namespace {

formats::Scene plates_of_mean() {
    formats::Scene scene = tests::make_plates(0.5f, 0.8f, 4);
    scene.materials[0].base_color = {0.4f, 0.4f, 0.4f};
    return scene;
}

// Of the upper plate's vertices, whose light comes from the lower one.
double difference_above(std::span<const double> a, std::span<const double> b) {
    double square = 0, all = 0;
    for (std::size_t v = a.size() / 2; v < a.size(); ++v) {
        square += (a[v] - b[v]) * (a[v] - b[v]);
        all += b[v] * b[v];
    }
    return std::sqrt(square / all);
}

// Halves of black and white: what cells do not blur stays.
TEST(TexturedBounces, ACoarseTextureIsSeenWhereItIs) {
    formats::Image8 halves{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
    const tests::BouncedIn plates(tests::make_textured_plates(halves, 1));
    const std::vector<double> points = plates.light(false), means = plates.light(true);
    EXPECT_LT(difference_above(means, points), 1e-6) << "texels are wider than cells";
    double dark = 0, bright = 0;
    for (std::size_t v = plates.receivers.size() / 2; v < plates.receivers.size(); ++v) {
        (plates.receivers[v].origin.x < 0.5f ? dark : bright) += means[v];
    }
    EXPECT_GT(bright, 1.5 * dark);
}

// Through the whole bake.
TEST(TexturedBounces, FilesHoldTheLightOfTheMean) {
    const std::vector<std::string> effects{"direct", "interreflection"};
    const auto light_of = [&](const formats::Scene& scene) {
        const auto baked = tests::bake_scene(scene, tests::bounce_options(effects));
        std::vector<double> green;
        for (const formats::Rgb c : tests::relight(baked.asset.view(), "white")) {
            green.push_back(static_cast<double>(c.g));
        }
        return green;
    };
    const auto checker = light_of(tests::make_textured_plates(tests::make_checker(256), 1));
    EXPECT_LT(difference_above(checker, light_of(plates_of_mean())), 1e-3);
}

}  // namespace
}  // namespace opaline::bake
