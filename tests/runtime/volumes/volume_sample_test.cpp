#include "runtime/volumes/volume_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

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
