// Light of a sun straight ahead comes through what the ray itself meets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "formats/opal/cubemap.h"
#include "formats/opal/phase_table.h"
#include "runtime/volumes/volume_march.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/lit_volumes.h"
#include "tests/support/cut_phase.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::LitTestVolumes;
using test::TestVolume;

constexpr double kLength = 6;  // [m] of each ray, about the middle of an even box

Vec3 toward_sun() {
    return formats::texel_direction(test::kSize, 4, 3, 3);
}

LightVector sun_of_texel() {
    return test::texel_light(test::kSize, 4 * 64 + 3 * 8 + 3, {1000, 500, 250});
}

// `reach`: the share of light that the nodes say reaches them from all around.
TestVolume even_box(float sigma_t, float reach) {
    const tests::CutPhase phase = tests::make_cut_phase(0.85);
    TestVolume volume;
    volume.single_terms = 25;
    volume.moment = phase.moments();
    volume.phase = phase;
    volume.sigma_t = {sigma_t, sigma_t, sigma_t};
    volume.albedo = {0.9f, 0.9f, 0.9f};
    volume.density = [](float, float, float) { return 1.0f; };
    volume.rows = [reach](formats::NodeVoxel) {
        return std::vector<formats::SparseRow>{test::constant_row(test::kSize, reach)};
    };
    return volume;
}

// A ray at an angle [degrees] to the sun's direction.
MarchRay ray_beside_sun(double degrees) {
    const Vec3 sun = toward_sun(), side = formats::normalize(cross(sun, Vec3{0, 1, 0}));
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 d = formats::normalize(static_cast<float>(std::cos(angle)) * sun +
                                      static_cast<float>(std::sin(angle)) * side);
    return {Vec3{4, 4, 4} + static_cast<float>(-0.5 * kLength) * d, d, 0, kLength};
}

float seen_at(const LitTestVolumes& lit, double degrees) {
    return march_volumes(lit.lit, ray_beside_sun(degrees)).radiance.r;
}

// Of a line of depth `tau` with `left` of its light behind all volumes: each place is as bright.
double exact(const LitTestVolumes& lit, double tau, double left) {
    const SunPhase& phase = lit.light.sun_phase[0];
    const auto t = static_cast<float>(left);
    const SunThrough through = find_sun_through(phase, {0.9f, 0.9f, 0.9f}, {t, t, t});
    double sum = 0;
    for (std::size_t j = 0; j < phase.terms; ++j) {
        const auto table =
            std::span(phase.table).subspan(j * formats::kPhaseEntries, formats::kPhaseEntries);
        sum += static_cast<double>(through[j].r * formats::eval_phase_table(table, 1));
    }
    return 0.9 * tau * left * sum * tests::flux(sun_of_texel(), 0);
}

// Nodes that are 8 voxels apart know the middle of the box no better than that light reaches all of
// it.
TEST(SunAhead, ThroughAnEvenBoxIsExactWhateverNodesSay) {
    for (const float sigma_t : {0.1f, 0.5f, 1.0f}) {
        const LitTestVolumes lit({even_box(sigma_t, 1)}, sun_of_texel());
        const double tau = kLength * static_cast<double>(sigma_t);
        const double expected = exact(lit, tau, std::exp(-tau));
        EXPECT_NEAR(static_cast<double>(seen_at(lit, 0)), expected, 1e-3 * expected) << sigma_t;
    }
}

TEST(SunAhead, ThroughTwoVolumesIsDimmedByBoth) {
    const LitTestVolumes lit({even_box(0.3f, 1), even_box(0.2f, 1)}, sun_of_texel());
    const double left = std::exp(-kLength * 0.5);
    const double expected = exact(lit, kLength * 0.3, left) + exact(lit, kLength * 0.2, left);
    EXPECT_NEAR(static_cast<double>(seen_at(lit, 0)), expected, 1e-3 * expected);
}

// A surface behind the volume hides the sun: nodes know, the ray does not.
TEST(SunAhead, OfPlacesInShadowStaysDark) {
    const LitTestVolumes dark({even_box(0.5f, 0)}, sun_of_texel());
    EXPECT_EQ(seen_at(dark, 0), 0);
    const LitTestVolumes dim({even_box(0.5f, 1e-3f)}, sun_of_texel());
    const LitTestVolumes dimmer({even_box(0.5f, 0.5e-3f)}, sun_of_texel());
    EXPECT_LT(seen_at(dimmer, 0), 0.6f * seen_at(dim, 0));
}

// Light from the side takes another way than the ray.
TEST(SunAhead, ElsewhereIsWhatNodesSay) {
    const LitTestVolumes whole({even_box(0.5f, 1)}, sun_of_texel());
    const LitTestVolumes ray({even_box(0.5f, static_cast<float>(std::exp(-1.5)))}, sun_of_texel());
    for (const double degrees : {12.5, 20.0, 90.0, 180.0}) {
        EXPECT_GT(seen_at(whole, degrees), 3 * seen_at(ray, degrees)) << degrees;
    }
    EXPECT_LT(seen_at(whole, 0), 1.5f * seen_at(ray, 0));
}

// No edge is seen around the sun: relative to its neighbours no step stands out.
TEST(SunAhead, NothingJumpsAsRaysTurnAway) {
    const LitTestVolumes lit({even_box(0.5f, 1)}, sun_of_texel());
    constexpr double kStepDegrees = 0.125;
    std::vector<double> logs;
    for (int i = 0; i < 120; ++i) {
        logs.push_back(std::log(static_cast<double>(seen_at(lit, kStepDegrees * i))));
    }
    for (std::size_t i = 2; i < logs.size(); ++i) {
        EXPECT_LT(std::abs(logs[i] - 2 * logs[i - 1] + logs[i - 2]), 0.02) << kStepDegrees * i;
        EXPECT_LT(std::abs(logs[i] - logs[i - 1]), 0.1) << kStepDegrees * i;
    }
}

TEST(SunAhead, OfRaysThatAreOpaqueIsFinite) {
    const LitTestVolumes lit({even_box(1e6f, 1)}, sun_of_texel());
    const float seen = seen_at(lit, 0);
    EXPECT_TRUE(std::isfinite(seen) && seen >= 0);
    EXPECT_LT(static_cast<double>(seen), 0.01 * tests::flux(sun_of_texel(), 0));
}

}  // namespace
}  // namespace opaline::runtime
