#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "runtime/volumes/volume_march.h"
#include "runtime/volumes/volume_sample.h"
#include "tests/runtime/volumes/lit_volumes.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::NodeVoxel;
using formats::Rgb;
using formats::SparseRow;
using formats::Vec3;
using test::LitTestVolumes;
using test::TestVolume;

using test::kSize;

// A cube of 12 voxels from 1.5 to 13.5 along each axis, its faces one voxel wide ramps.
TestVolume box() {
    TestVolume volume;
    volume.extent = {2, 2, 2};
    volume.single_terms = 1;
    volume.density = [](float x, float y, float z) {
        return std::min({x, y, z}) >= 2 && std::max({x, y, z}) <= 13 ? 1.0f : 0.0f;
    };
    return volume;
}

// A smooth ball of the deviation 5 voxels around index (32, 32, 32), coloured light in it.
TestVolume blob() {
    TestVolume volume;
    volume.extent = {8, 8, 8};
    volume.spacing = 4;
    volume.single_terms = 4;
    volume.multiple_terms = 1;
    volume.moment = {1, 0.5f, 0, 0, 0};
    volume.sigma_t = {0.2f, 0.1f, 0.05f};
    volume.albedo = {0.9f, 0.8f, 0.5f};
    volume.density = [](float x, float y, float z) {
        const float r2 = (x - 32) * (x - 32) + (y - 32) * (y - 32) + (z - 32) * (z - 32);
        return r2 < 30 * 30 ? std::exp(-r2 / 50) : 0.0f;
    };
    volume.rows = [](NodeVoxel node) {
        return std::vector<SparseRow>{
            test::constant_row(kSize, 0.5f + 0.4f * std::sin(0.1f * static_cast<float>(node[0]))),
            test::constant_row(kSize, 0.01f * static_cast<float>(node[1] + node[2]))};
    };
    return volume;
}

void expect_near(Rgb found, Rgb expected, float tolerance) {
    EXPECT_NEAR(found.r, expected.r, tolerance);
    EXPECT_NEAR(found.g, expected.g, tolerance);
    EXPECT_NEAR(found.b, expected.b, tolerance);
}

TEST(VolumeMarch, HomogeneousBoxOfConstantSource) {
    TestVolume volume = box();
    volume.sigma_t = {0.05f, 0.1f, 0.3f};
    volume.albedo = {0.9f, 0.5f, 0.25f};
    const LitTestVolumes scene({volume});
    for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}}) {
        const Vec3 centre{7.5f, 7.5f, 7.5f};
        const MarchResult seen = march_volumes(scene.lit, {centre - 100 * direction, direction});
        const auto t = [](float sigma) { return std::exp(-12 * sigma); };
        expect_near(seen.transmittance, {t(0.05f), t(0.1f), t(0.3f)}, 1e-5f);
        expect_near(seen.radiance,
                    {0.9f * (1 - t(0.05f)), 0.5f * (1 - t(0.1f)), 0.25f * (1 - t(0.3f))}, 2e-5f);
    }
}

TEST(VolumeMarch, ABoxFromInsideAndPastItsSide) {
    TestVolume volume = box();
    volume.sigma_t = {0.1f, 0.1f, 0.1f};
    const LitTestVolumes scene({volume});
    const MarchResult half = march_volumes(scene.lit, {{7.5f, 7.5f, 7.5f}, {0, 0, 1}});
    EXPECT_NEAR(half.transmittance.r, std::exp(-0.6), 1e-5);
    const MarchResult part = march_volumes(scene.lit, {{7.5f, 7.5f, -5}, {0, 0, 1}, 10, 15});
    EXPECT_NEAR(part.transmittance.r, std::exp(-0.5), 1e-5);
    const MarchResult past = march_volumes(scene.lit, {{7.5f, 14.5f, -5}, {0, 0, 1}});
    EXPECT_EQ(past.transmittance, (Rgb{1, 1, 1}));
    EXPECT_EQ(past.radiance, Rgb{});
}

TEST(VolumeMarch, WhatIsNearlyOpaqueIsOpaque) {
    TestVolume volume = box();
    volume.sigma_t = {10, 10, 10};
    const LitTestVolumes scene({volume});
    const MarchResult seen = march_volumes(scene.lit, {{-9, 7.2f, 7.9f}, {1, 0, 0}});
    EXPECT_EQ(seen.transmittance, Rgb{});
    expect_near(seen.radiance, {1, 1, 1}, 1.1e-3f);
}

TEST(VolumeMarch, ARayInTwoPartsIsTheWholeRay) {
    const LitTestVolumes scene({blob()});
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> near(26, 38), cut(60, 110);
    for (int i = 0; i < 50; ++i) {
        const Vec3 target{near(generator), near(generator), near(generator)};
        const Vec3 origin{-50, near(generator), near(generator)};
        const MarchRay whole{origin, formats::normalize(target - origin)};
        MarchRay first = whole, second = whole;
        first.end = second.begin = static_cast<double>(cut(generator));
        const MarchResult all = march_volumes(scene.lit, whole);
        const MarchResult a = march_volumes(scene.lit, first), b = march_volumes(scene.lit, second);
        ASSERT_LT(all.transmittance.r, 0.9f);
        expect_near(a.transmittance * b.transmittance, all.transmittance, 3e-4f);
        expect_near(a.radiance + a.transmittance * b.radiance, all.radiance, 3e-4f);
    }
}

TEST(VolumeMarch, HalfASourceStepIsSmallAgainstFineSteps) {
    const LitTestVolumes scene({blob()});
    const MarchRay ray{{-50, 30, 28}, formats::normalize({1, 0.03f, 0.05f})};
    const MarchResult fine = march_volumes(scene.lit, ray, {.step = 1.0f / 32});
    const MarchResult usual = march_volumes(scene.lit, ray);
    expect_near(usual.transmittance, fine.transmittance, 2e-4f);
    expect_near(usual.radiance, fine.radiance, 3e-4f * fine.radiance.r);
}

TEST(VolumeMarch, TwoVolumesInOnePlaceAreOneOfTwiceTheDensity) {
    TestVolume dense = blob();
    dense.sigma_t = 2 * dense.sigma_t;
    const LitTestVolumes two({blob(), blob()}), one({dense});
    for (const float y : {25.0f, 32.0f, 41.3f}) {
        const MarchRay ray{{-20, y, 30}, formats::normalize({1, 0.1f, 0})};
        const MarchResult a = march_volumes(two.lit, ray), b = march_volumes(one.lit, ray);
        expect_near(a.transmittance, b.transmittance, 1e-5f);
        expect_near(a.radiance, b.radiance, 1e-5f * b.radiance.r);
    }
}

TEST(VolumeMarch, VolumesThatOverlapInPartAddUp) {
    TestVolume fine = box(), coarse = box();
    fine.sigma_t = {0.1f, 0.1f, 0.1f};
    fine.to_world = {0.25f, 0, 0, 5, 0, 0.25f, 0, 5, 0, 0, 0.25f, 5};
    fine.albedo = {1, 0, 0};
    coarse.sigma_t = {0.07f, 0.07f, 0.07f};
    coarse.albedo = {0, 1, 0};
    const LitTestVolumes scene({coarse, fine});
    const MarchResult seen = march_volumes(scene.lit, {{6.9f, 6.9f, -30}, {0, 0, 1}});
    EXPECT_NEAR(seen.transmittance.r, std::exp(-12 * 0.07 - 3 * 0.1), 1e-4);
    EXPECT_EQ(seen.radiance.b, 0);
    EXPECT_NEAR(seen.radiance.r + seen.radiance.g, 1 - seen.transmittance.r, 1e-4);
    // Red comes from 5.375 to 8.375 m, behind 3.875 m of the other one.
    const double red = std::exp(-0.07 * 3.875) * (0.1 / 0.17) * (1 - std::exp(-3 * 0.17));
    EXPECT_NEAR(seen.radiance.r, red, 1e-3);
}

TEST(VolumeMarch, AGaussianBallUnderAShearedTransform) {
    TestVolume volume = blob();
    volume.to_world = {0.3f, 0.2f, 0, 3, -0.1f, 0.05f, 0.6f, -2, 0, 0.7f, 0.1f, 40};
    const LitTestVolumes scene({volume});
    const auto& m = volume.to_world;
    const auto world = [&](Vec3 i, float one) {
        return Vec3{m[0] * i.x + m[1] * i.y + m[2] * i.z + one * m[3],
                    m[4] * i.x + m[5] * i.y + m[6] * i.z + one * m[7],
                    m[8] * i.x + m[9] * i.y + m[10] * i.z + one * m[11]};
    };
    const Vec3 centre = world({32, 32, 32}, 1);
    for (const Vec3 index_direction :
         {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.3f, -0.8f, 0.5f}, Vec3{-1, 1, 1}}) {
        const Vec3 direction = world(index_direction, 0);
        const float metres = length(direction);
        const double voxels_per_metre = length(index_direction) / metres;
        const MarchResult seen = march_volumes(
            scene.lit, {centre - (1000 / metres) * direction, (1 / metres) * direction});
        const double depth = 5 * std::sqrt(2 * std::numbers::pi) / voxels_per_metre;
        // Trilinear density widens the ball by a share of a voxel.
        EXPECT_NEAR(-std::log(seen.transmittance.r), 0.2 * depth, 0.015 * 0.2 * depth);
        EXPECT_NEAR(-std::log(seen.transmittance.b), 0.05 * depth, 0.015 * 0.05 * depth);
    }
}

TEST(VolumeMarch, ANegativeTableCornerAndMissingBricks) {
    // Two lone bricks far apart along z, the table between them empty.
    TestVolume volume = box();
    volume.first_brick = {-1, -1, -30};
    volume.extent = {1, 1, 60};
    volume.sigma_t = {0.1f, 0.1f, 0.1f};
    volume.density = [](float, float, float z) {
        return (z >= -238 && z <= -235) || (z >= 234 && z <= 237) ? 1.0f : 0.0f;
    };
    const LitTestVolumes scene({volume});
    EXPECT_EQ(scene.view.records[0].brick_count, 2u);
    for (const float sign : {1.0f, -1.0f}) {
        const MarchResult seen =
            march_volumes(scene.lit, {{-4, -4.5f, -1000 * sign}, {0, 0, sign}});
        EXPECT_NEAR(seen.transmittance.r, std::exp(-0.8), 1e-5);
    }
    EXPECT_NEAR(volumes_span(scene.lit, {{-4, -4.5f, -1000}, {0, 0, 1}}).end, 1240, 1e-6);
    EXPECT_EQ(volumes_span(scene.lit, {{4, -4.5f, -1000}, {0, 0, 1}, 3}).end, 3);
    EXPECT_EQ(volumes_span(scene.lit, {{4, -4.5f, -1000}, {0, 0, 1}, 3, 9}).begin, 9);
    EXPECT_LT(volumes_span(scene.lit, {{-4, -4.5f, -1000}, {0, 0, 1}}).begin, 1240);
}

TEST(VolumeMarch, SourcesBelowZeroCountAsZeroBetweenNodesToo) {
    TestVolume volume = box();
    volume.extent = {1, 1, 1};
    volume.spacing = 8;
    volume.sigma_t = {1e-3f, 1e-3f, 1e-3f};
    volume.density = [](float, float, float) { return 1.0f; };
    // J = V goes from 1 at z = 0 to -1 at z = 8.
    volume.rows = [](NodeVoxel node) {
        return std::vector<SparseRow>{test::constant_row(kSize, node[2] == 0 ? 1.0f : -1.0f)};
    };
    const LitTestVolumes scene({volume});
    const MarchResult seen = march_volumes(scene.lit, {{3, 3, -10}, {0, 0, 1}, 10, 17});
    // The integral of 1 - z / 4 up to 4.
    EXPECT_NEAR(seen.radiance.r, 1e-3 * 2, 1e-5);
}

TEST(VolumeMarch, NodesWithoutNumberAreBlack) {
    TestVolume volume = box();
    volume.sigma_t = {0.1f, 0.1f, 0.1f};
    LitTestVolumes scene({volume});
    std::ranges::fill(scene.volumes.corner, formats::kNoNode);
    const MarchResult seen = march_volumes(scene.lit, {{7, 7, -10}, {0, 0, 1}});
    EXPECT_EQ(seen.radiance, Rgb{});
    EXPECT_NEAR(seen.transmittance.r, std::exp(-1.2), 1e-5);
}

// Smooth in density and source, coloured, forward scattering, under a sheared transform.
TestVolume sheared_blob() {
    TestVolume volume;
    volume.first_brick = {-2, 0, -1};
    volume.extent = {4, 4, 4};
    volume.to_world = {0.3f, 0.2f, 0, 3, -0.1f, 0.05f, 0.6f, -2, 0, 0.7f, 0.1f, 40};
    volume.spacing = 4;
    volume.single_terms = 4;
    volume.multiple_terms = 1;
    volume.moment = {1, 0.5f, 0, 0, 0};
    volume.sigma_t = {0.2f, 0.1f, 0.05f};
    volume.albedo = {0.9f, 0.8f, 0.5f};
    volume.density = [](float x, float y, float z) {
        return std::max(0.0f, 1 - (x * x + (y - 16) * (y - 16) + (z - 8) * (z - 8)) / 200);
    };
    volume.rows = [](NodeVoxel node) {
        return std::vector<SparseRow>{
            test::constant_row(kSize, 0.5f + 0.4f * std::sin(0.1f * static_cast<float>(node[0]))),
            test::constant_row(kSize, 0.01f * static_cast<float>(node[1] + node[2]))};
    };
    return volume;
}

Vec3 world(const TestVolume& volume, Vec3 i) {
    const auto& m = volume.to_world;
    return {m[0] * i.x + m[1] * i.y + m[2] * i.z + m[3],
            m[4] * i.x + m[5] * i.y + m[6] * i.z + m[7],
            m[8] * i.x + m[9] * i.y + m[10] * i.z + m[11]};
}

// One step of a march takes the integrands at its midpoint: over the length h it adds
// scattered (1 - exp(-c h)) / c and lets exp(-c h) through.
TEST(VolumeSample, IsWhatOneShortStepOfAMarchSees) {
    const TestVolume volume = sheared_blob();
    const LitTestVolumes scene({volume, volume}, test::texel_light(kSize, 70, {300, 200, 100}));
    std::mt19937 generator(11);
    std::uniform_real_distribution<float> within(-6, 6), any(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const Vec3 point =
            world(volume, {within(generator), 16 + within(generator), 8 + within(generator)});
        const Vec3 direction =
            formats::normalize({any(generator), any(generator), 0.1f + any(generator)});
        const double h = 0.02;
        const auto march = march_volumes(
            scene.lit, {point - 10.0f * direction, direction, 10 - h / 2, 10 + h / 2}, {.step = 8});
        const VolumeSample sample = sample_volumes(scene.lit, point, -1 * direction);
        const auto expect = [&](float c, float scattered, float radiance, float transmittance) {
            const double depth = static_cast<double>(c) * h;
            ASSERT_GT(depth, 1e-4);
            EXPECT_NEAR(transmittance, std::exp(-depth), 1e-6);
            const double added =
                static_cast<double>(scattered) / static_cast<double>(c) * -std::expm1(-depth);
            EXPECT_NEAR(radiance, added, 1e-3 * added + 1e-12);
        };
        expect(sample.extinction.r, sample.scattered.r, march.radiance.r, march.transmittance.r);
        expect(sample.extinction.g, sample.scattered.g, march.radiance.g, march.transmittance.g);
        expect(sample.extinction.b, sample.scattered.b, march.radiance.b, march.transmittance.b);
    }
}

TEST(VolumeSample, NothingOutsideAndFiniteAnywhere) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    TestVolume dense = sheared_blob();
    dense.sigma_t = {1e38f, 1, 1};
    const LitTestVolumes scene({dense, dense}, test::texel_light(kSize, 70, {300, 200, 100}));
    const float values[] = {0,
                            -0.0f,
                            40,
                            1e-40f,
                            -1e20f,
                            3e38f,
                            -3e38f,
                            std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::quiet_NaN()};
    for (const float x : values) {
        for (const float y : values) {
            const VolumeSample sample = sample_volumes(scene.lit, {x, y, 40}, {0, 0, 1});
            for (const Rgb c : {sample.extinction, sample.scattered}) {
                for (const float band : {c.r, c.g, c.b}) {
                    ASSERT_TRUE(std::isfinite(band) && band >= 0);
                }
            }
        }
    }
    const VolumeSample inside = sample_volumes(scene.lit, world(dense, {0, 16, 8}), {0, 0, 1});
    EXPECT_GT(inside.extinction.r, 1e10f);
    const VolumeSample outside = sample_volumes(scene.lit, {1000, 0, 0}, {0, 0, 1});
    EXPECT_EQ(outside.extinction, Rgb{});
    EXPECT_EQ(outside.scattered, Rgb{});
}

}  // namespace

}  // namespace opaline::runtime
