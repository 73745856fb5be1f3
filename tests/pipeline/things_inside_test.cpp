// Bakes of opaque things inside translucent bodies, and of bodies that stand on a floor.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/media_bake.h"
#include "tests/support/touching_bodies.h"

namespace opaline::bake {
namespace {

using tests::make_box;

// The body, and a thing that is diffuse and of one colour.
tests::Scene make_scene_around(tests::Primitive body, const formats::Medium& medium,
                               tests::Primitive thing, formats::Rgb color) {
    tests::Scene scene =
        tests::make_nested_scene({{std::move(body), medium}, {std::move(thing), medium}});
    scene.materials[1].medium.reset();
    scene.materials[1].base_color = color;
    return scene;
}

BakeOptions walked_bake() {
    BakeOptions options;
    options.quality = Quality::draft;
    options.cubemap_size = 8;
    options.threads = 2;
    return options;
}

struct Host {
    std::string name;
    tests::Primitive body, thing;
    formats::Medium medium;
    double off;  // of the mean from 1
};

class ThingsInside : public testing::TestWithParam<Host> {};

TEST_P(ThingsInside, ShowTheSkyWhereNothingAbsorbs) {
    const Host& host = GetParam();
    const tests::Scene scene = make_scene_around(host.body, host.medium, host.thing, {1, 1, 1});
    const BakeResult baked = tests::bake_scene(scene, walked_bake());
    for (const std::size_t p : {0u, 1u}) {
        EXPECT_NEAR(tests::mean_green(tests::relight_primitive(baked.asset, "white", p)), 1,
                    host.off)
            << p;
    }
}

std::vector<Host> make_hosts() {
    const formats::Medium fog = tests::make_grey_medium(5, 0, 1),
                          milk = tests::make_grey_medium(15, 0, 1.33f),
                          glass = tests::make_smooth_glass(1.5f);
    const tests::Primitive box = make_box({-1, -1, -1}, {1, 1, 1}, 5), ball = tests::make_sphere(3),
                           inner = tests::make_sphere(2, 0.5f, {0.1f, 0.2f, 0}),
                           stick = make_box({-0.2f, -0.5f, -0.2f}, {0.2f, 1.8f, 0.2f}, 4);
    tests::Primitive floor = tests::make_quad({-3, -1, -3}, {0, 0, 6}, {6, 0, 0}, 6);
    return {{"BallInGlass", box, inner, glass, 0.06},   {"BallInFog", ball, inner, fog, 0.03},
            {"BallInMilk", ball, inner, milk, 0.04},    {"StickHalfInMilk", box, stick, milk, 0.06},
            {"FloorUnderMilk", box, floor, milk, 0.06}, {"FloorUnderFog", box, floor, fog, 0.06}};
}

std::string name_of_host(const testing::TestParamInfo<Host>& of) {
    return of.param.name;
}

INSTANTIATE_TEST_SUITE_P(Hosts, ThingsInside, testing::ValuesIn(make_hosts()), name_of_host);

// A ball of radius a in the middle of one of radius R and index 1. Light whose direction makes a
// cosine m with the normal has come sqrt(R^2 - a^2 (1 - m^2)) - a m through the medium:
//     L_o = albedo 2 integral of m exp(-sigma_a way(m)) over [0, 1].
TEST(ThingInTintedGlass, IsLitByWhatTheGlassLeaves) {
    const double a = 0.5, R = 1, sigma_a = 0.7;
    double integral = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
        const double m = (i + 0.5) / kSteps;
        const double way = std::sqrt(R * R - a * a * (1 - m * m)) - a * m;
        integral += 2 * m * std::exp(-sigma_a * way) / kSteps;
    }
    const formats::Medium glass = tests::make_grey_medium(0, static_cast<float>(sigma_a), 1);
    const tests::Scene scene =
        make_scene_around(tests::make_sphere(3), glass,
                          tests::make_sphere(3, static_cast<float>(a)), {0.8f, 0.4f, 0.1f});
    const BakeResult baked = tests::bake_scene(scene, walked_bake());
    const auto shown = tests::relight_primitive(baked.asset, "white", 1);
    formats::Rgb mean{0, 0, 0};
    for (const formats::Rgb& c : shown) {
        mean = mean + 1 / static_cast<float>(shown.size()) * c;
    }
    EXPECT_NEAR(double{mean.r}, 0.8 * integral, 0.02);
    EXPECT_NEAR(double{mean.g}, 0.4 * integral, 0.01);
    EXPECT_NEAR(double{mean.b}, 0.1 * integral, 0.003);
}

}  // namespace
}  // namespace opaline::bake
