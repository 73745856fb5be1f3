// Light of suns that is scattered once, seen through nodes, rays and single points.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "formats/opal/cubemap.h"
#include "runtime/volumes/node_radiance.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/volume_march.h"
#include "runtime/volumes/volume_sample.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/lit_volumes.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/cut_phase.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::NodeVoxel;
using formats::Rgb;
using formats::SparseRow;
using formats::TermSet;
using formats::Vec3;
using test::LitTestVolumes;
using test::TestVolume;

using test::kSize;
constexpr std::uint32_t kTexel = 3 * kSize * kSize + 2 * kSize + 5;

Vec3 toward_texel() {
    return formats::texel_direction(kSize, 3, 2, 5);
}

// Thin, with V = 1 and what a bake makes of a Henyey-Greenstein function.
TestVolume forward(double g) {
    TestVolume volume;
    volume.single_terms = 25;
    test::scatter_forward(volume, g);
    volume.sigma_t = {1e-5f, 1e-5f, 1e-5f};
    return volume;
}

// Unit directions at all angles from `axis`, `count` of them.
std::vector<Vec3> directions_around(Vec3 axis, int count) {
    const Vec3 side = formats::normalize(cross(axis, Vec3{0.3f, 0.5f, 0.8f}));
    const Vec3 other = cross(axis, side);
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double angle = (i + 0.5) * std::numbers::pi / count, turn = 2.4 * i;
        directions.push_back(static_cast<float>(std::cos(angle)) * axis +
                             static_cast<float>(std::sin(angle) * std::cos(turn)) * side +
                             static_cast<float>(std::sin(angle) * std::sin(turn)) * other);
    }
    return directions;
}

// Light that is scattered once in a thin homogeneous medium shows L = tau_s p(-l . w_o) flux, its
// peak included: tau_s = tau / (1 - peak), because the file's tau leaves the peak out. The texel's
// light is a sun.
TEST(SunLight, AThinMediumUnderATexelShowsThePhaseFunctionAtAllAngles) {
    for (const double g : {0.5, 0.75, 0.85, 0.95}) {
        const LightVector light = test::texel_light(kSize, kTexel, {1000, 500, 250});
        const LitTestVolumes lit({forward(g)}, light);
        ASSERT_EQ(lit.light.part[0].suns, 1u);
        const tests::CutPhase phase = tests::make_cut_phase(g);
        const double flux = tests::flux(light, 0);
        for (const Vec3 to_eye : directions_around(toward_texel(), 400)) {
            const double c = -static_cast<double>(dot(to_eye, toward_texel()));
            const MarchRay ray{Vec3{4, 4, 4} + 3.0f * to_eye, -1 * to_eye, 0, 6};
            const MarchResult seen = march_volumes(lit.lit, ray);
            const double expected = 6e-5 / (1 - phase.peak) * phase.whole(c) * flux;
            EXPECT_NEAR(seen.radiance.r, expected, (g > 0.9 ? 0.09 : 0.02) * expected)
                << g << " at cosine " << c;
            EXPECT_NEAR(seen.radiance.g, seen.radiance.r / 2, 1e-5f * seen.radiance.r);
            EXPECT_NEAR(seen.radiance.b, seen.radiance.r / 4, 1e-5f * seen.radiance.r);
            const VolumeSample sample = sample_volumes(lit.lit, {4, 4, 4}, to_eye);
            EXPECT_NEAR(6 * sample.scattered.r, seen.radiance.r, 1e-3f * seen.radiance.r);
            const auto nodes = node_radiance(lit.view, lit.light, 0, 1e4f * to_eye);
            EXPECT_NEAR(6e-5f * nodes[0].r, seen.radiance.r, 0.03f * seen.radiance.r);
        }
    }
}

// The sun is dealt out to the texels around it, but scatters from where it is.
TEST(SunLight, ASmallLightBetweenTexelsShowsThePhaseFunctionToo) {
    const tests::CutPhase phase = tests::make_cut_phase(0.85);
    for (const Vec3 toward : {Vec3{0.2f, 0.1f, 1}, Vec3{1, 0.9f, -0.3f}, Vec3{0.5f, -1, 0.25f}}) {
        formats::Environment sky;
        sky.discs.push_back({formats::normalize(toward), 0.00465f, {1e4f, 1e4f, 1e4f}});
        const LightVector light = project_environment(sky, kSize);
        const double flux = tests::flux(light, 0);
        const LitTestVolumes lit({forward(0.85)}, light);
        for (const Vec3 to_eye : directions_around(formats::normalize(toward), 200)) {
            const double c = -static_cast<double>(dot(to_eye, formats::normalize(toward)));
            const double seen =
                static_cast<double>(sample_volumes(lit.lit, {4, 4, 4}, to_eye).scattered.r) / 1e-5;
            const double expected = phase.whole(c) / (1 - phase.peak) * flux;
            EXPECT_NEAR(seen, expected, 0.06 * expected) << c;
        }
    }
}

// All that is scattered once of a sun, the peak that the file counts as light that goes on
// included.
TEST(SunLight, TheMeanOverAllDirectionsIsTheLightOverTheSphere) {
    const LightVector light = test::texel_light(kSize, kTexel, {1000, 500, 250});
    const LitTestVolumes lit({forward(0.85)}, light);
    const double peak = tests::make_cut_phase(0.85).peak;
    const double expected = tests::flux(light, 0) / (1 - peak) / (4 * std::numbers::pi);
    EXPECT_NEAR(node_radiance(lit.view, lit.light, 0, std::nullopt)[0].r, expected,
                5e-3 * expected);
    // A Fibonacci lattice.
    constexpr int kDirections = 20000;
    double mean = 0;
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
        const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const Vec3 to_eye{static_cast<float>(r * std::cos(turn)),
                          static_cast<float>(r * std::sin(turn)), static_cast<float>(z)};
        mean += static_cast<double>(sample_volumes(lit.lit, {4, 4, 4}, to_eye).scattered.r) / 1e-5 /
                kDirections;
    }
    EXPECT_NEAR(mean, expected, 5e-3 * expected);
}

// Where light is even there is no sun, and a white medium of V = 1 shows 1 in all directions.
TEST(SunLight, EvenLightIsSeenEvenlyWithoutSuns) {
    const LitTestVolumes lit({forward(0.85)}, test::white_light(kSize));
    EXPECT_EQ(lit.light.part[0].suns, 0u);
    for (const Vec3 to_eye : directions_around(toward_texel(), 50)) {
        EXPECT_NEAR(sample_volumes(lit.lit, {4, 4, 4}, to_eye).scattered.r / 1e-5f, 1, 0.02);
    }
}

// An eye that stands still while a small light turns by 17 degrees around it, over edges of texels.
// A jump stays as large when steps become shorter.
TEST(SunLight, IsContinuousAsASmallLightTurns) {
    formats::Environment sky;
    sky.width = 4;
    sky.height = 2;
    sky.pixel.assign(8, {0.2f, 0.2f, 0.2f});
    sky.discs.push_back({formats::normalize({0.2f, 0.1f, 1}), 0.00465f, {3e4f, 3e4f, 3e4f}});
    const Vec3 to_eye = formats::normalize({0.9f, 0.3f, -0.5f});
    const auto largest_step = [&](int steps) {
        float before = 0, largest = 0, most = 0;
        for (int i = 0; i <= steps; ++i) {
            const float angle = 0.3f * static_cast<float>(i) / static_cast<float>(steps);
            const LightVector light = project_environment(sky, kSize, rotation_about_y(angle), 1);
            const LitTestVolumes lit({forward(0.85)}, light, {.threads = 1});
            EXPECT_GT(lit.light.part[0].suns, 0u);
            const float seen = sample_volumes(lit.lit, {4, 4, 4}, to_eye).scattered.r;
            if (i > 0) largest = std::max(largest, std::abs(seen - before));
            before = seen;
            most = std::max(most, seen);
        }
        EXPECT_GT(most, 0);
        return largest / most;
    };
    const float coarse = largest_step(400), fine = largest_step(800);
    EXPECT_LT(coarse, 4e-3f);
    EXPECT_LT(fine, 0.6f * coarse);
}

// 12 texels, of which the ninth brightest and those below stay with the polynomial.
LightVector many_suns() {
    std::vector<Rgb> map(formats::cubemap_texels(kSize), {1, 1, 1});
    for (std::uint32_t i = 0; i < 12; ++i) {
        const auto bright = static_cast<float>(100 + 60 * i);
        map[31 * i + 3] = {bright, 2 * bright, 0.5f * bright};
    }
    return runtime::project_cubemap(map, kSize);
}

// Rows that differ from node to node and by direction.
TestVolume varied(double g) {
    TestVolume volume = forward(g);
    volume.spacing = 2;
    volume.extent = {3, 2, 2};
    volume.multiple_terms = 4;
    volume.rows = [](NodeVoxel node) {
        std::vector<SparseRow> rows;
        for (int k = 0; k < 5; ++k) {
            const float at = 0.3f * static_cast<float>(node[0] + 2 * node[1] - node[2] + k);
            rows.push_back(test::constant_row(kSize, 0.5f + 0.2f * std::sin(at)));
            rows.back().index = {3, 70, 200};
            rows.back().value = {0.2f, 0.1f * std::cos(at), 0.1f};
        }
        return rows;
    };
    return volume;
}

// Each volume meets the light as it would alone, its own phase function and rows: they are too thin
// to dim each other.
TEST(SunLight, OfVolumesThatNeedNoSunsIsTheWholeLight) {
    TestVolume isotropic = varied(0.5);
    isotropic.single_terms = 1;
    isotropic.multiple_terms = 0;
    isotropic.moment = {1, 0, 0, 0, 0};
    isotropic.phase = nullptr;
    isotropic.rows = nullptr;
    const LightVector light = many_suns();
    std::vector<TestVolume> volumes{isotropic, varied(0.85), varied(0.5)};
    for (TestVolume& volume : volumes) {
        volume.sigma_t = {1e-9f, 1e-9f, 1e-9f};
    }
    const LitTestVolumes both(volumes, light);
    EXPECT_EQ(both.light.part[0].suns, 0u);
    EXPECT_EQ(both.light.part[1].suns, kMaxSuns);
    for (std::size_t v = 0; v < volumes.size(); ++v) {
        const LitTestVolumes alone({volumes[v]}, light);
        for (const auto& eye : {std::optional<Vec3>(), std::optional<Vec3>(Vec3{90, -20, 31})}) {
            const auto among = node_radiance(both.view, both.light, v, eye);
            const auto own = node_radiance(alone.view, alone.light, 0, eye);
            for (std::size_t i = 0; i < own.size(); ++i) {
                EXPECT_NEAR(among[i].g, own[i].g, 1e-5f * own[i].g);
            }
        }
    }
    const auto found = node_radiance(both.view, both.light, 0, std::nullopt)[0].r;
    EXPECT_NEAR(found, tests::flux(light, 0) / (4 * std::numbers::pi), 1e-4f * found);
}

TEST(SunLight, IsPartOfSingleScatteringAlone) {
    const LightVector light = many_suns();
    const LitTestVolumes all({varied(0.85)}, light),
        once({varied(0.85)}, light, {TermSet::volume_single}),
        often({varied(0.85)}, light, {TermSet::volume_multiple});
    EXPECT_EQ(often.light.part[0].suns, 0u);
    EXPECT_EQ(often.light.part[0].terms, 4u);
    EXPECT_EQ(once.light.part[0].suns, kMaxSuns);
    const auto mean = [](const LitTestVolumes& lit) {
        return node_radiance(lit.view, lit.light, 0, std::nullopt)[17].g;
    };
    EXPECT_NEAR(mean(all), mean(once) + mean(often), 1e-5f * mean(all));
}

TEST(SunLight, OfHostileLightAndDamagedPhaseFunctionsIsFiniteAndNotNegative) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const auto expect_sound = [](const LitTestVolumes& lit) {
        for (const Rgb c : lit.light.coefficient) {
            ASSERT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b));
        }
        for (const Vec3 to_eye : directions_around(toward_texel(), 40)) {
            const Rgb seen = march_volumes(lit.lit, {100.0f * to_eye, -1 * to_eye}).radiance;
            const Rgb at = sample_volumes(lit.lit, {4, 4, 4}, to_eye).scattered;
            const Rgb node = node_radiance(lit.view, lit.light, 0, 90.0f * to_eye)[0];
            for (const float x : {seen.r, seen.g, seen.b, at.r, at.g, at.b, node.r, node.g}) {
                ASSERT_TRUE(std::isfinite(x) && x >= 0);
            }
        }
    };
    for (const float value : {nan, infinity, -infinity, 3e38f, -3e38f, 0.0f, 1e-40f}) {
        LightVector light = many_suns();
        light.rgba[4 * kTexel] = value;
        expect_sound(LitTestVolumes({varied(0.85)}, light));
        std::ranges::fill(light.rgba, value);
        expect_sound(LitTestVolumes({varied(0.85)}, light));
        LitTestVolumes damaged({varied(0.85)}, many_suns());
        std::ranges::fill(damaged.volumes.phase, value);
        expect_sound(damaged);
    }
}

}  // namespace
}  // namespace opaline::runtime
