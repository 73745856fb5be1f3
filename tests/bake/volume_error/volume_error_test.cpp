#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "bake/check/volumes/see_through.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/check/volumes/volume_probes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

Knobs small_knobs() {
    Knobs knobs = tests::small_knobs(Quality::production, 2);
    knobs.set(kVolumeWalks, 64);
    return knobs;
}

// The volumes of a scene as a file holds them.
formats::Asset bake(const formats::Scene& scene, const Knobs& knobs) {
    const auto rays = RayScene::build(scene, 2);
    const VolumePlan plan = plan_volumes(scene, knobs);
    StageLog log;
    formats::Asset asset;
    asset.transport = formats::make_sparse_rows(knobs.cubemap_size, knobs.code_bits);
    asset.volumes = std::move(*bake_volumes({scene, *rays, plan.layouts, knobs}, {}, log));
    return asset;
}

VolumeErrorReport check(const formats::Scene& scene, const formats::Asset& asset,
                        unsigned threads = 2) {
    VolumeCheckOptions options;
    options.noise_share = 0.3;
    Context context;
    context.threads = threads;
    return *check_volumes(scene, asset.view(), options, context);
}

formats::Scene blob_scene(float albedo, float g) {
    return tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 6), 4, albedo, g));
}

const VolumeErrorReport::Part& part(const VolumeErrorReport& report, LightPlace place) {
    return report.by_light[static_cast<std::size_t>(place)];
}

TEST(VolumeError, OfABlobThatAbsorbsNothingIsAboutZeroUnderEvenLight) {
    // Half of a mean free path between nodes.
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 0.125), 2, 1, 0));
    Knobs knobs = small_knobs();
    knobs.set(kVolumeWalks, 128);
    const VolumeErrorReport report = check(scene, bake(scene, knobs));
    ASSERT_EQ(report.by_light.size(), kLightPlaces);
    EXPECT_LT(part(report, LightPlace::around).rms_relative, 0.03);
    EXPECT_NEAR(part(report, LightPlace::around).bias, 0, 0.02);
    EXPECT_LT(report.rms_relative, 0.2);
    EXPECT_LE(report.ci95[0], report.rms_relative);
    EXPECT_GE(report.ci95[1], report.rms_relative);
}

// Under even light nothing is lost that goes on instead of being scattered by a hair: a file counts
// the peak of a phase function as light that goes on, a picture shows both together.
TEST(VolumeError, UnderEvenLightTheForwardPeakIsSeenThroughTheVolume) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 6), 2, 1, 0.85f));
    Knobs knobs = small_knobs();
    knobs.set(kVolumeWalks, 16);
    knobs.set(kVolumeTerms, 9);
    const VolumeErrorReport report = check(scene, bake(scene, knobs));
    const VolumeErrorReport::Part& even = part(report, LightPlace::around);
    EXPECT_GT(even.scattered_alone, 0.15);
    EXPECT_LT(even.rms_relative, 0.05);
    EXPECT_EQ(part(report, LightPlace::ahead).rms_relative,
              part(report, LightPlace::ahead).scattered_alone);
}

// exp(-4 0.5 sqrt(2 pi)) straight through the middle of a blob.
TEST(VolumeError, WhatPassesThroughIsWhatBeerAndLambertSay) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 24), 2, 1, 0));
    const auto reference = make_reference_scene(scene, 1);
    std::vector<VolumeProbe> probes = choose_volume_probes(*reference, 1, 1);
    VolumeRay& ray = probes[0].ray[static_cast<std::size_t>(LightPlace::around)];
    ray.origin = {-5, 0, 0};
    ray.direction = {1, 0, 0};
    EXPECT_NEAR(see_through_scene(scene.volumes, probes)[0], std::exp(-2.5066282746), 1e-3);
    ray.end = 20;
    EXPECT_EQ(see_through_scene(scene.volumes, probes)[0], 0) << "a surface is there";
}

TEST(VolumeError, OfAFileThatScattersTooLittleRisesByWhatIsMissing) {
    const formats::Scene scene = blob_scene(0.9f, 0);
    formats::Asset asset = bake(scene, small_knobs());
    const VolumeErrorReport whole = check(scene, asset);
    for (formats::VolumeRecord& record : asset.volumes.records) {
        record.albedo = 0.7f * record.albedo;
    }
    const VolumeErrorReport damaged = check(scene, asset);
    EXPECT_GT(damaged.rms_relative, 0.25);
    EXPECT_GT(damaged.rms_relative, 1.5 * whole.rms_relative);
    for (std::size_t place = 0; place < kLightPlaces; ++place) {
        EXPECT_NEAR(1 + damaged.by_light[place].bias, 0.7 * (1 + whole.by_light[place].bias), 0.05);
    }
}

// A floor ends rays, hides the sky from below and is not itself seen: what it reflects is on
// neither side.
TEST(VolumeError, IsSmallAboveAFloorToo) {
    formats::Scene scene = blob_scene(0.9f, 0);
    scene.primitives.push_back(tests::make_quad({-9, -0.6f, -9}, {0, 0, 18}, {18, 0, 0}, 1));
    const VolumeErrorReport report = check(scene, bake(scene, small_knobs()));
    EXPECT_GT(report.rays_checked, 100u);
    EXPECT_LT(part(report, LightPlace::around).rms_relative, 0.06);
    EXPECT_LT(report.rms_relative, 0.3);
}

TEST(VolumeError, RaysOfAFileSeeWhatIsInFrontOfTheirEnd) {
    const formats::Scene scene = blob_scene(0.9f, 0);
    const formats::Asset asset = bake(scene, small_knobs());
    const auto reference = make_reference_scene(scene, 1);
    std::vector<VolumeProbe> probes = choose_volume_probes(*reference, 8, 1);
    const auto march = [&] {
        return march_probes(asset.volumes.view(), 8, glm::dvec3(0), probes, 1);
    };
    const std::vector<double> whole = march();
    for (VolumeProbe& probe : probes) {
        for (VolumeRay& ray : probe.ray) {
            ray.end = -glm::dot(ray.origin, ray.direction);  // beside the middle
        }
    }
    const std::vector<double> half = march();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_GT(half[i], 0);
        EXPECT_LT(half[i], 0.999 * whole[i]);
    }
}

// Pairs whose truth is known without noise: each class counts alike, however bright its light.
TEST(VolumeError, TotalIsTheMeanSquareOfTheParts) {
    constexpr std::size_t kProbes = 10;
    VolumeTruth truth;
    std::vector<double> luminance;
    for (std::size_t place = 0; place < kLightPlaces; ++place) {
        const double bright = std::pow(2.0, static_cast<double>(place));
        for (std::size_t p = 0; p < kProbes; ++p) {
            Moments m;
            m.add(glm::dvec3(bright));
            truth.luminance.push_back(m);
            luminance.push_back(place == 0 ? 1.4 * bright : bright);
        }
    }
    const VolumeErrorReport report = compare_volumes(luminance, {}, truth, 0);
    EXPECT_NEAR(report.rms_relative, 0.2, 1e-9);
    EXPECT_NEAR(report.by_light[0].rms_relative, 0.4, 1e-9);
    EXPECT_NEAR(report.by_light[0].bias, 0.4, 1e-9);
    EXPECT_EQ(report.by_light[3].rms_relative, 0);
}

// A volume that scatters forward alone: an error of .01 where even light makes 1.
TEST(VolumeError, OfViewsThatAreDarkIsRelativeToATenthOfEvenLight) {
    constexpr std::size_t kProbes = 10;
    VolumeTruth truth;
    std::vector<double> luminance;
    for (const double bright : {1.0, 1e-12, 0.0, 1.0}) {
        for (std::size_t p = 0; p < kProbes; ++p) {
            Moments m;
            m.add(glm::dvec3(bright));
            truth.luminance.push_back(m);
            luminance.push_back(bright == 1 ? bright : bright + 0.01);
        }
    }
    const VolumeErrorReport report = compare_volumes(luminance, {}, truth, 0);
    for (const std::size_t place : {1u, 2u}) {
        EXPECT_NEAR(report.by_light[place].rms_relative, 0.1, 1e-9);
        EXPECT_NEAR(report.by_light[place].bias, 0.1, 1e-9);
        EXPECT_NEAR(report.by_light[place].ci95[1], 0.1, 1e-9);
    }
    EXPECT_NEAR(report.rms_relative, std::sqrt(0.5) * 0.1, 1e-9);
}

TEST(VolumeError, NoiseOfThePathsIsNoErrorOfTheFile) {
    const formats::Scene scene = blob_scene(0.9f, 0);
    const auto reference = make_reference_scene(scene, 1);
    const std::vector<VolumeProbe> probes = choose_volume_probes(*reference, 64, 3);
    const auto never = [](const VolumeTruth&) { return false; };
    const auto few = trace_volume_truth(*reference, probes, 1, 20000, never, {});
    const auto many = trace_volume_truth(*reference, probes, 2, 2000000, never, {});
    ASSERT_GT(many->samples, 30 * few->samples);
    std::vector<double> luminance;
    for (const Moments& m : many->luminance) {
        luminance.push_back(m.mean.x);
    }
    const VolumeErrorReport report = compare_volumes(luminance, {}, *few, 0);
    double noise = 0;
    for (const VolumeErrorReport::Part& own : report.by_light) {
        noise += own.noise * own.noise / kLightPlaces;
    }
    EXPECT_GT(std::sqrt(noise), 0.1);
    EXPECT_LT(report.rms_relative, 0.6 * std::sqrt(noise));
}

constexpr std::uint32_t kCount = 400;

formats::Scene blob_scene() {
    return tests::scene_of(tests::make_volume(tests::make_blob(0.5, 0.125), 4, 0.9f, 0));
}

std::vector<VolumeProbe> probes_of(const formats::Scene& scene) {
    const auto reference = make_reference_scene(scene, 1);
    return choose_volume_probes(*reference, kCount, 1);
}

TEST(VolumeProbes, RaysSeeTheSunFromAheadBesideAndBehind) {
    const std::vector<VolumeProbe> probes = probes_of(blob_scene());
    ASSERT_EQ(probes.size(), kCount);
    constexpr std::array<std::array<float, 2>, 3> kCosines{{{0.5f, 1}, {-0.5f, 0.5f}, {-1, -0.5f}}};
    for (const VolumeProbe& probe : probes) {
        EXPECT_NEAR(glm::length(probe.sun), 1, 1e-5f);
        for (std::size_t place = 0; place < kCosines.size(); ++place) {
            const float cosine = glm::dot(probe.sun, probe.ray[place].direction);
            EXPECT_GE(cosine, kCosines[place][0] - 1e-4f);
            EXPECT_LE(cosine, kCosines[place][1] + 1e-4f);
        }
    }
}

TEST(VolumeProbes, RaysComeFromOutsideAndMeetMuchOfTheDensity) {
    const formats::Scene scene = blob_scene();
    const formats::SparseGrid<float>& grid = scene.volumes[0].density;
    const glm::mat4 to_index(glm::inverse(grid.to_scene));
    double column = 0, count = 0;
    for (const VolumeProbe& probe : probes_of(scene)) {
        for (const VolumeRay& ray : probe.ray) {
            EXPECT_EQ(grid.sample(glm::vec3(to_index * glm::vec4(ray.origin, 1))), 0);
            EXPECT_EQ(ray.end, std::numeric_limits<float>::infinity());
            for (float t = 0; t < 16; t += 0.02f) {
                column += 0.02 * static_cast<double>(grid.sample(glm::vec3(
                                     to_index * glm::vec4(ray.origin + t * ray.direction, 1))));
            }
            ++count;
        }
    }
    // Of points drawn in proportion to exp(-r^2 / 2 s^2), the mean of the distance from the line to
    // the middle has two of three axes: the mean column is that of the middle, sqrt(2 pi) s, times
    // 1 / 2.
    EXPECT_NEAR(column / count, 0.5 * std::sqrt(2 * 3.14159) * 0.5, 0.04);
}

TEST(VolumeProbes, SurfacesEndRaysAndHideWhatIsBeforeThem) {
    formats::Scene scene = blob_scene();
    // A wall through the middle, seen from both sides.
    tests::Primitive wall = tests::make_quad({-90, 0, -90}, {0, 0, 180}, {180, 0, 0}, 1);
    scene.primitives.push_back(wall);
    scene.materials[0].double_sided = true;
    double ending = 0;
    for (const VolumeProbe& probe : probes_of(scene)) {
        for (const VolumeRay& ray : probe.ray) {
            const float slope = ray.direction.y;
            ending += ray.end < 1e9f ? 1 : 0;
            if (ray.end < 1e9f) {
                EXPECT_NEAR(ray.origin.y + ray.end * slope, 0, 1e-2f);
            } else {
                // It begins on the wall, or leaves it behind.
                EXPECT_GT(ray.origin.y * slope, -1e-2f);
            }
        }
    }
    // Every line meets the wall once: behind the point that it was drawn through, or before it.
    EXPECT_NEAR(ending / (kLightPlaces * kCount), 0.5, 0.1);
}

TEST(VolumeProbes, NothingIsChosenWhereNoDensityIs) {
    formats::Scene scene;
    scene.materials.resize(1);
    EXPECT_TRUE(probes_of(scene).empty());
}

}  // namespace

}  // namespace opaline::bake
