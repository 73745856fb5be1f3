// Bakes of bodies that touch, overlap and contain each other, without absorption, under an even
// sky: each vertex shows what the sky shows, whether anybody sees it or not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/media_bake.h"
#include "tests/support/touching_bodies.h"

namespace opaline::bake {
namespace {

BakeOptions coarse_bake() {
    BakeOptions options;
    options.quality = Quality::draft;
    options.cubemap_size = 8;
    options.set(kSamples, 1000);
    options.set(kWalks, 50000);
    options.set(kSites, 500);
    options.threads = 2;
    return options;
}

class TouchingBodies : public testing::TestWithParam<tests::BodiesThatMeet> {};

TEST_P(TouchingBodies, ThatAbsorbNothingShowTheSky) {
    const tests::Scene scene = tests::make_nested_scene(GetParam().parts);
    const BakeResult baked = tests::bake_scene(scene, coarse_bake());
    // Of so few samples and walks; rows of clear bodies blur what crosses them.
    const bool has_clear = std::ranges::any_of(
        GetParam().parts, [](const auto& part) { return part.second.sigma_s == formats::Rgb{}; });
    const double most_bias = has_clear ? 0.15 : 0.08, most_rms = has_clear ? 0.4 : 0.1;
    double square = 0;
    std::size_t count = 0;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const auto shown = tests::relight_primitive(baked.asset, "white", p);
        const double mean = tests::mean_green(shown);
        EXPECT_NEAR(mean, 1, most_bias) << p;
        for (const formats::Rgb& c : shown) {
            square += (double{c.g} - 1) * (double{c.g} - 1);
            ++count;
        }
    }
    const double rms = std::sqrt(square / static_cast<double>(count));
    RecordProperty("rms", std::to_string(rms));
    RecordProperty("stated", std::to_string(baked.error.rms_relative));
    EXPECT_LT(rms, 1.3 * baked.error.rms_relative);
    EXPECT_LT(rms, most_rms);
}

// Two of one material: the dipole would count faces in one plane twice.
TEST(OverlappingBodies, OfOneMediumThatAbsorbsNothingShowTheSky) {
    const formats::Medium milk = tests::make_grey_medium(20, 0, 1.3f);
    for (const bool has_planes : {true, false}) {
        SCOPED_TRACE(has_planes);
        tests::Scene scene = tests::make_nested_scene(
            {{has_planes ? tests::make_box({0, 0, 0}, {2, 2, 2}, 5) : tests::make_sphere(3), milk},
             {has_planes ? tests::make_box({1, 0, 0}, {3, 2, 2}, 5)
                         : tests::make_sphere(3, 1, {1, 0.3f, 0}),
              milk}});
        for (formats::Primitive& p : scene.primitives) {
            p.material = 0;
        }
        const BakeResult baked = tests::bake_scene(scene, coarse_bake());
        for (std::size_t p = 0; p < 2; ++p) {
            const auto shown = tests::relight_primitive(baked.asset, "white", p);
            EXPECT_NEAR(tests::mean_green(shown), 0.97, 0.05) << p;
            for (const formats::Rgb& c : shown) {
                EXPECT_NEAR(c.g, 1, 0.25f);
            }
        }
    }
}

std::string name_of_bodies(const testing::TestParamInfo<tests::BodiesThatMeet>& of) {
    return of.param.name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, TouchingBodies, testing::ValuesIn(tests::make_bodies_that_meet()),
                         name_of_bodies);

}  // namespace
}  // namespace opaline::bake
