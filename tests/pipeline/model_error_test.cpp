#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "bake/check/model_pairs.h"
#include "runtime/light_vector.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

ModelErrorReport check(const tests::Scene& scene, const BakeResult& baked,
                       ModelCheckOptions wanted = {}) {
    wanted.simulated = held_light(all_effects(), baked.plan);
    auto report = check_model(scene, baked.asset.view(), wanted, {});
    EXPECT_TRUE(report);
    return std::move(report).value();
}

BakeOptions fine_bake() {
    BakeOptions options = tests::small_bake();
    options.cubemap_size = 32;
    return options;
}

// Far from all else a volume without absorption is as bright as even light. A black one that is a
// ball of radius r takes the share (r / d)^2 from a plane below, at the distance d of its centre.
TEST(ModelError, WhatAThickCloudScattersToTheGroundIsMissing) {
    constexpr float kSize = 0.05f;
    tests::Scene scene = tests::make_scene(
        {tests::make_quad({-kSize, -1, -kSize}, {0, 0, 2 * kSize}, {2 * kSize, 0, 0}, 2)});
    scene.volumes = {tests::make_volume(tests::make_ball_grid(0.5, 0.05), 12, 1, 0)};
    BakeOptions options = tests::only({"direct"});
    options.cubemap_size = 32;
    const BakeResult baked = tests::bake_scene(scene, options);
    ModelCheckOptions quick;
    quick.noise = 0.02;
    quick.max_events = 100000;
    const ModelErrorReport report = check(scene, baked, quick);
    EXPECT_EQ(report.by_light[0].name, "white");
    EXPECT_NEAR(report.by_light[0].missing, 0.25, 0.02);
    EXPECT_NEAR(report.by_light[0].bias, 0, 0.02);
    EXPECT_LT(report.by_light[0].rms_relative, 0.05);
}

// (d + noise)^2 is d^2 + variance in the mean. Here d is 0 (convex and opaque again; white light
// has no texels) and one round of samples is all noise: were it not subtracted, the error would be
// the noise.
TEST(ModelError, UnderWhiteIsZeroWithinItsIntervalHoweverMuchNoiseThereIs) {
    const tests::Scene scene = tests::make_scene({tests::make_sphere(3)});
    const BakeResult baked = tests::bake_scene(scene, fine_bake());
    ModelCheckOptions quick;
    quick.max_events = 1;
    constexpr int kSeeds = 4;
    double share_of_noise = 0, bias = 0;
    for (quick.seed = 0; quick.seed < kSeeds; ++quick.seed) {
        const ModelErrorReport report = check(scene, baked, quick);
        const ModelErrorReport::Part& white = report.by_light[0];
        EXPECT_GT(white.noise, 0.015);
        EXPECT_EQ(white.samples, 64u);
        share_of_noise += white.rms_relative / white.noise / kSeeds;
        bias += white.bias / kSeeds;
    }
    // 192 receivers: the sum of squares is off by sqrt(2 / 192) of the variance, either way.
    EXPECT_LT(share_of_noise, 0.5);
    EXPECT_LT(std::abs(bias), 0.0125) << "8 standard errors of 768 means";
}

TEST(ModelError, WeighsInterreflectionButDoesNotCountIt) {
    // A corner of two white quads: each sees the other under half of its sky.
    const tests::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 9),
                           tests::make_quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, 9)});
    BakeOptions options = fine_bake();
    options.effects = {"direct"};
    const ModelErrorReport report = check(scene, tests::bake_scene(scene, options));
    EXPECT_GT(report.missing, 0.1);
    EXPECT_LT(report.by_light[0].rms_relative, 0.01);
    const tests::Scene convex = tests::make_scene({tests::make_sphere(2)});
    EXPECT_EQ(check(convex, tests::bake_scene(convex, tests::small_bake())).missing, 0)
        << "nothing to be reflected from";
}

TEST(ModelError, OfMirroredLightIsStatedForGlossyOpaqueSurfacesAlone) {
    tests::Scene scene = tests::make_scene({tests::make_sphere(3)});
    EXPECT_FALSE(check(scene, tests::bake_scene(scene, tests::small_bake())).mirrored);
    scene.materials[0].gloss.metallic = 1;
    scene.materials[0].gloss.roughness = 0.5f;
    BakeResult baked = tests::bake_scene(scene, tests::small_bake());
    const ModelErrorReport report = check(scene, baked);
    ASSERT_TRUE(report.mirrored);
    EXPECT_EQ(report.mirrored->receivers_checked, report.receivers_checked);
    EXPECT_LT(report.mirrored->rms_relative, 0.03) << "convex: nothing to shadow or to mirror";
    EXPECT_LT(std::abs(report.mirrored->bias), 0.02);
    // A file that mirrors half as much is half wrong.
    baked.asset.gloss[0].f0 = {0, 0, 0};
    for (formats::Rgb& color : baked.asset.base_color) {
        color = {0.5f * color.r, 0.5f * color.g, 0.5f * color.b};
    }
    EXPECT_NEAR(check(scene, baked).mirrored->rms_relative, 0.5, 0.05);
}

// One mean free path thick, lit from both sides: the dipole gives it the light of a half space.
TEST(ModelError, OfAThinSheetIsThatItIsTooBright) {
    const tests::Scene scene =
        tests::make_translucent_scene(tests::make_sheet(0.1f), tests::make_grey_medium(9.9f, 0.1f));
    BakeOptions options = tests::only({"multiple", "single"});
    options.cubemap_size = 16;
    const ModelErrorReport report = check(scene, tests::bake_scene(scene, options));
    EXPECT_GT(report.ci95[0], 0.1);
    EXPECT_GT(report.bias, 0.1);
    EXPECT_GT(report.receivers_checked, 15u) << "without the edges";
    EXPECT_GT(report.missing, 0.1) << "what crosses it unscattered";
    EXPECT_EQ(report.left_out,
              (std::vector<std::string>{"sun:30,60", "sun:150,35", "sun:270,15", "sky:3,35"}));
    ASSERT_EQ(report.by_light.size(), 3u);
    EXPECT_EQ(report.by_light[2].name, "sky:3,35 without its sun");
}

// Right for a thick body, which shows that suns of path and file are alike; wrong for a thin one.
TEST(ModelError, OfSunsBehindRefractingBoundariesIsStatedByItself) {
    BakeOptions options = fine_bake();
    options.effects = {"multiple", "single"};
    ModelCheckOptions wanted;
    wanted.max_events = 2000000;
    const tests::Scene thick =
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(60, 0.6f));
    const auto ball = check(thick, tests::bake_scene(thick, options), wanted).suns;
    ASSERT_TRUE(ball);
    EXPECT_NEAR(ball->bias, 0, 0.05);
    EXPECT_LT(ball->ci95[0], 0.1);
    EXPECT_GT(ball->noise, 0.1) << "or it is no test of what is subtracted";
    EXPECT_GT(ball->receivers_checked, 100u);
    const tests::Scene thin =
        tests::make_translucent_scene(tests::make_sheet(0.1f), tests::make_grey_medium(9.9f, 0.1f));
    const auto sheet = check(thin, tests::bake_scene(thin, options), wanted).suns;
    ASSERT_TRUE(sheet);
    EXPECT_GT(sheet->ci95[0], 0.1);
    std::printf("suns: ball %.3f [%.3f, %.3f], mean %+.3f, noise %.3f; sheet %.3f [%.3f, %.3f]\n",
                ball->rms_relative, ball->ci95[0], ball->ci95[1], ball->bias, ball->noise,
                sheet->rms_relative, sheet->ci95[0], sheet->ci95[1]);
}

TEST(ModelError, SunsAreConnectedToThroughMatchedBoundaries) {
    ModelCheckOptions wanted;
    wanted.max_events = 100000;
    const tests::Scene scene =
        tests::make_translucent_scene({tests::make_sphere(2)}, tests::make_grey_medium(50, 5, 1));
    const ModelErrorReport report =
        check(scene, tests::bake_scene(scene, tests::small_bake()), wanted);
    EXPECT_EQ(report.by_light.size(), 6u);
    EXPECT_TRUE(report.left_out.empty());
    EXPECT_FALSE(report.suns);
    for (const ModelErrorReport::Part& light : report.by_light) {
        EXPECT_LT(light.noise, 0.1) << light.name;
        EXPECT_LT(light.rms_relative, 0.2) << light.name << ": a thick body";
    }
}

TEST(ModelError, AgainstTruthTracedBeforeTheBakeIsTheSame) {
    const tests::Scene scene = tests::make_ball_on_floor(tests::make_grey_medium(2, 0.1f));
    const BakeResult baked = tests::bake_scene(scene, tests::small_bake());
    ModelCheckOptions options;
    options.simulated = held_light(all_effects(), baked.plan);
    options.receivers = 16;
    options.max_events = 1;
    options.noise_share = 0;  // of a file to come nothing is known
    const auto probes = choose_model_probes(scene, options.receivers, options.seed, {});
    ASSERT_TRUE(probes);
    const auto truth = trace_model_truth(scene, *probes, options, {});
    ASSERT_TRUE(truth);
    std::vector<std::vector<double>> luminance;
    const formats::AssetView asset = baked.asset.view();
    for (const ModelLight& light : probes->lights) {
        const runtime::LightVector vector =
            runtime::project_environment(light.environment, asset.cubemap_size, {}, 1);
        luminance.push_back(relight_receivers(asset, probes->receivers, {.vector = vector}));
    }
    const ModelErrorReport early = compare_with_truth(luminance, *truth, *probes, options.seed);
    const ModelErrorReport late = check(scene, baked, options);
    EXPECT_GT(late.rms_relative, 0);
    EXPECT_EQ(early.rms_relative, late.rms_relative);
    EXPECT_EQ(early.ci95[0], late.ci95[0]);
    EXPECT_EQ(early.ci95[1], late.ci95[1]);
    EXPECT_EQ(early.bias, late.bias);
}

TEST(ModelError, IsMeasuredOnRequestAndKeptInTheFileWithoutItsSeconds) {
    BakeOptions options = tests::small_bake();
    const tests::Scene scene = tests::make_scene({tests::make_sphere(1)});
    EXPECT_FALSE(tests::bake_scene(scene, options).model_error);
    options.check_model = true;
    const BakeResult baked = tests::bake_scene(scene, options);
    ASSERT_TRUE(baked.model_error);
    EXPECT_GT(baked.model_error->seconds, 0);
    EXPECT_NE(baked.asset.provenance.find("\"model_error\""), std::string::npos);
    EXPECT_EQ(baked.asset.provenance.find("\"seconds\""), std::string::npos);
}

}  // namespace
}  // namespace opaline::bake
