// Light that volumes send out by themselves, along rays and at points.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "runtime/volumes/volume_bounds.h"
#include "runtime/volumes/volume_sample.h"
#include "tests/runtime/volumes/glow_support.h"
#include "tests/runtime/volumes/lit_volumes.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::kSize;
using test::TestVolume;

// A smooth ball around index (16, 16, 16), of deviation 3 voxels.
float blob_at(float x, float y, float z) {
    const float r2 = (x - 16) * (x - 16) + (y - 16) * (y - 16) + (z - 16) * (z - 16);
    return r2 < 200 ? std::exp(-r2 / 18) : 0.0f;
}

TestVolume glowing_blob() {
    TestVolume volume;
    volume.extent = {5, 5, 5};
    volume.single_terms = 1;
    volume.density = blob_at;
    return volume;
}

// The line through the middle of the blob.
const MarchRay kRay{{-10, 16, 16}, {1, 0, 0}};
const float kColumn = 3 * std::sqrt(2 * 3.14159265f);

struct Glowing {
    formats::Volumes volumes = test::make_volumes(kSize);
    VolumeLight light;
    LitVolumes lit;

    Glowing(const TestVolume& volume, const std::function<Rgb(float, float, float)>& emission,
            const EmitterLight& emitters = {}, Rgb scattered = {}) {
        test::add_volume(volumes, volume);
        test::add_glow(volumes, volume, emission, scattered);
        light = relight_volumes(volumes.view(), {},
                                {.terms = formats::TermSet::none, .emitters = emitters});
        lit = light_volumes(volumes.view(), light);
    }
    Glowing(const Glowing&) = delete;
    Glowing& operator=(const Glowing&) = delete;
};

void expect_close(Rgb found, Rgb expected, float relative) {
    EXPECT_NEAR(found.r, expected.r, relative * expected.r);
    EXPECT_NEAR(found.g, expected.g, relative * expected.g);
    EXPECT_NEAR(found.b, expected.b, relative * expected.b);
}

TEST(VolumeGlow, ShowsItsOwnRadianceTimesWhatItAbsorbs) {
    TestVolume volume = glowing_blob();
    volume.sigma_t = {0.02f, 0.3f, 2};
    const Rgb own{3, 2, 1};
    const Glowing glowing(volume, [&](float x, float y, float z) {
        return blob_at(x, y, z) * (volume.sigma_t * own);
    });
    const MarchResult seen = march_volumes(glowing.lit, kRay);
    const auto absorbed = [](float depth) { return -std::expm1(-depth); };
    expect_close(
        seen.radiance,
        own * Rgb{absorbed(0.02f * kColumn), absorbed(0.3f * kColumn), absorbed(2 * kColumn)},
        0.01f);  // red is dark: 2^-9 of the largest channel
    EXPECT_NEAR(seen.transmittance.r, std::exp(-0.02f * kColumn), 1e-3f);
}

TEST(VolumeGlow, NeedsNoDensity) {
    TestVolume volume = glowing_blob();
    volume.sigma_t = {0, 0, 0};
    const Glowing glowing(volume, [](float x, float y, float z) {
        return blob_at(x, y, z) * Rgb{1, 2, 3};
    });
    const MarchResult seen = march_volumes(glowing.lit, kRay);
    expect_close(seen.radiance, kColumn * Rgb{1, 2, 3}, 3e-3f);
    EXPECT_EQ(seen.transmittance, (Rgb{1, 1, 1}));
}

TEST(VolumeGlow, FollowsTheColourOfItsEmitterAndIsOffWhereThatIsBlack) {
    const auto emission = [](float x, float y, float z) { return blob_at(x, y, z) * Rgb{1, 1, 1}; };
    const Rgb scattered{0.5f, 0.25f, 1};
    const auto see = [&](const EmitterLight& emitters) {
        return march_volumes(Glowing(glowing_blob(), emission, emitters, scattered).lit, kRay)
            .radiance;
    };
    const Rgb plain = see({});
    const std::array<Rgb, 1> tinted{{{2, 0.5f, 0}}}, black{{{0, 0, 0}}};
    expect_close(see({tinted}), Rgb{2, 0.5f, 0} * plain, 1e-5f);
    EXPECT_EQ(see({black}), Rgb{});
    EXPECT_EQ(see(dark_emitters()), Rgb{});
    // Without what is seen directly, what nodes scatter of it is left: J = E_0 Y_0 everywhere.
    const Rgb indirect = see({{}, false});
    const float depth = -std::expm1(-kColumn);
    expect_close(indirect, 0.2820948f * depth * scattered, 3e-3f);
    // Both add up.
    const Rgb straight = march_volumes(Glowing(glowing_blob(), emission).lit, kRay).radiance;
    expect_close(plain, straight + indirect, 1e-4f);
}

TEST(VolumeGlow, APointHasTheIntegrandsOfARay) {
    const Glowing glowing(glowing_blob(), [](float x, float y, float z) {
        return blob_at(x, y, z) * Rgb{1, 2, 4};
    });
    Rgb radiance;
    float depth = 0;
    constexpr float kStep = 0.05f;
    for (float t = 0.5f * kStep; t < 60; t += kStep) {
        const VolumeSample sample =
            sample_volumes(glowing.lit, kRay.origin + t * kRay.direction, {-1, 0, 0});
        const float absorbed = -std::expm1(-kStep * sample.extinction.g);
        const float way = sample.extinction.g > 1e-6f ? absorbed / sample.extinction.g : kStep;
        radiance = radiance + std::exp(-depth) * way * sample.scattered;
        depth += kStep * sample.extinction.g;
    }
    expect_close(march_volumes(glowing.lit, kRay).radiance, radiance, 3e-3f);
}

TEST(VolumeGlow, BoxesHoldTheirLightToo) {
    TestVolume volume = glowing_blob();
    volume.density = [](float x, float y, float z) {
        return x == 16 && y == 16 && z == 16 ? 1.0f : 0.0f;
    };
    formats::Volumes volumes = test::make_volumes(kSize);
    test::add_volume(volumes, volume);
    const auto dark = volume_corners(volumes.view());
    EXPECT_EQ(dark.at(7), (Vec3{17, 17, 17}));
    test::add_glow(volumes, volume,
                   [](float x, float y, float z) {
                       return x == 20 && y == 17 && z == 16 ? Rgb{1, 1, 1} : Rgb{};
                   },
                   {});
    EXPECT_EQ(volume_corners(volumes.view()).at(7), (Vec3{21, 18, 17}));
    EXPECT_EQ(volume_corners(volumes.view(), 0).at(0), (Vec3{15, 15, 15}));
}

}  // namespace
}  // namespace opaline::runtime
