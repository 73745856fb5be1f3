#include "bake/lab/sweep/probes.h"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/support/bake.h"

namespace opaline::tests {
namespace {

using bake::choose_probes;

TEST(Probes, AreAllReceiversOfASmallSceneAndSpreadOverALargeOne) {
    EXPECT_THAT(choose_probes(5, 10), ::testing::ElementsAre(0u, 1u, 2u, 3u, 4u));
    const auto probes = choose_probes(100000, 1000);
    ASSERT_EQ(probes.size(), 1000u);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        EXPECT_EQ(probes[i] / 100, i);  // one in each run of a hundred
    }
    EXPECT_TRUE(choose_probes(0, 10).empty());
}

// An open white plane returns under `white` what it gets: radiance 1.
TEST(Probes, OpenWhitePlaneReturnsWhiteLight) {
    bake::BakeOptions options;
    options.cubemap_size = 16;
    options.coefficients = bake::kAllCoefficients;
    const auto bake =
        bake_scene(make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 2)}), options);
    const auto lights = bake::make_probe_lights(16, 1);
    ASSERT_TRUE(lights);
    ASSERT_EQ(lights->names.front(), "white");
    const std::vector<std::uint32_t> probes = choose_probes(bake.asset.position.size(), 100);
    const auto luminance = bake::relight_probes(bake.asset.view(), probes, *lights);
    ASSERT_EQ(luminance.size(), probes.size() * lights->names.size());
    for (std::size_t p = 0; p < probes.size(); ++p) {
        EXPECT_NEAR(luminance[p * lights->names.size()], 1, 0.01);  // 8-bit codes, 16 texels
    }
}

// Of a dented ball over a floor sixteen coefficients tell less than a hundred.
TEST(Probes, FewerCoefficientsErrMore) {
    const auto lights = bake::make_probe_lights(8, 2);
    ASSERT_TRUE(lights);
    const auto relit = [&](std::uint32_t coefficients) {
        bake::BakeOptions options;
        options.cubemap_size = 8;
        options.coefficients = coefficients;
        const auto bake = bake_scene(make_dented_ball(), options);
        return bake::relight_probes(bake.asset.view(),
                                    choose_probes(bake.asset.position.size(), 200), *lights);
    };
    const auto all = relit(bake::kAllCoefficients);
    const double few = bake::relative_difference(relit(16), all);
    const double many = bake::relative_difference(relit(100), all);
    EXPECT_GT(many, 0);
    EXPECT_GT(few, 2 * many);
}

// Half as much light everywhere is an error of a half, under each light and on either surface.
TEST(Probes, ErrorIsRelativeToTheTruth) {
    const std::vector<double> truth{1, 2, 3, 4, 5, 6};
    std::vector<double> half;
    for (const double t : truth) {
        half.push_back(t / 2);
    }
    const std::vector<std::string> lights{"a", "b"};
    const auto report = bake::compare_probes(
        half, truth, std::vector<std::string>{"single", "direct", "single"}, lights);
    EXPECT_NEAR(report.rms_relative, 0.5, 1e-12);
    EXPECT_NEAR(report.ci95[0], 0.5, 1e-12);
    EXPECT_NEAR(report.ci95[1], 0.5, 1e-12);
    EXPECT_EQ(report.receivers_checked, 3u);
    ASSERT_EQ(report.by_effect.size(), 2u);
    EXPECT_EQ(report.by_effect[0].name, "single");
    EXPECT_EQ(report.by_effect[1].name, "direct");
    for (const auto& light : report.by_light) {
        EXPECT_NEAR(light.rms_relative, 0.5, 1e-12) << light.name;
    }
    EXPECT_NEAR(bake::relative_difference(half, truth), 0.5, 1e-12);
    EXPECT_EQ(bake::relative_difference(std::vector<double>{1}, std::vector<double>{0}), 0);
}

// 3 and 4 make 5; what the truth does not know of itself stays as it is.
TEST(Probes, TheTruthsOwnErrorIsAddedInSquares) {
    bake::ErrorReport error, truth;
    error.rms_relative = error.ci95[0] = error.ci95[1] = 0.03;
    error.by_light = {{"white", 0.03}, {"studio", 0.03}};
    truth.rms_relative = 0.04;
    truth.by_light = {{"white", 0.04}};
    const double low = error.ci95[0];
    bake::add_error_of_truth(error, truth);
    EXPECT_NEAR(error.rms_relative, 0.05, 1e-15);
    EXPECT_EQ(error.ci95[0], low) << "errors of one origin do not add";
    EXPECT_NEAR(error.ci95[1], 0.05, 1e-15);
    EXPECT_NEAR(error.by_light[0].rms_relative, 0.05, 1e-15);
    EXPECT_NEAR(error.by_light[1].rms_relative, 0.03, 1e-15);
}

}  // namespace
}  // namespace opaline::tests
