// Bakes of bodies that touch, overlap and contain each other, without absorption, under an even
// sky: each vertex shows what the sky shows, whether anybody sees it or not.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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
    // Of so few samples and walks.
    constexpr double kCoarse = 0.15;
    double square = 0;
    std::size_t count = 0;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const auto shown = tests::relight_primitive(baked.asset, "white", p);
        const double mean = tests::mean_green(shown);
        std::printf("%s: %.3f\n", scene.materials[p].name.c_str(), mean);
        EXPECT_NEAR(mean, 1, kCoarse) << p;
        for (const formats::Rgb& c : shown) {
            square += (double{c.g} - 1) * (double{c.g} - 1);
            ++count;
        }
    }
    const double rms = std::sqrt(square / static_cast<double>(count));
    std::printf("RMS %.3f, stated %.3f\n", rms, baked.error.rms_relative);
    EXPECT_LT(rms, 1.3 * baked.error.rms_relative);
}

std::string name_of_bodies(const testing::TestParamInfo<tests::BodiesThatMeet>& of) {
    return of.param.name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, TouchingBodies, testing::ValuesIn(tests::make_bodies_that_meet()),
                         name_of_bodies);

}  // namespace
}  // namespace opaline::bake
