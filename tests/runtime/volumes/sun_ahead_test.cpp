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

namespace opaline::runtime {
namespace {

using formats::Vec3;
using test::LitTestVolumes;
using test::TestVolume;

constexpr double kLength = 40;  // [m] of each ray, about the middle of an even box

Vec3 toward_sun() {
    return formats::texel_direction(test::kSize, 4, 3, 3);
}

LightVector sun_of_texel() {
    return test::texel_light(test::kSize, 4 * 64 + 3 * 8 + 3, {1000, 500, 250});
}

// Of 16 x 16 x 16 m. `reach`: the share of light that rows say reaches nodes from all around.
TestVolume even_box(float sigma_t, float reach, std::uint32_t spacing = 2) {
    TestVolume volume;
    volume.extent = {2, 2, 2};
    volume.spacing = spacing;
    volume.single_terms = 25;
    test::scatter_forward(volume, 0.85);
    volume.sigma_t = {sigma_t, sigma_t, sigma_t};
    volume.albedo = {0.9f, 0.9f, 0.9f};
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
    return {Vec3{8, 8, 8} + static_cast<float>(-0.5 * kLength) * d, d, 0, kLength};
}

float seen_at(const LitTestVolumes& lit, double degrees) {
    return march_volumes(lit.lit, ray_beside_sun(degrees)).radiance.r;
}

// V T is the same all along a ray toward the sun, e^-tau of the whole: tau albedo E T sum T^p q.
// `share` of tau is the box's.
double exact(const LitTestVolumes& lit, std::size_t volume, double share) {
    const float left = march_volumes(lit.lit, ray_beside_sun(0)).transmittance.r;
    const SunPhase& phase = lit.light.sun_phase[volume];
    const SunThrough through = find_sun_through(phase, {0.9f, 0.9f, 0.9f}, {left, left, left});
    double sum = 0;
    for (std::size_t j = 0; j < phase.terms; ++j) {
        const auto table =
            std::span(phase.table).subspan(j * formats::kPhaseEntries, formats::kPhaseEntries);
        sum += static_cast<double>(through[j].r * formats::eval_phase_table(table, 1));
    }
    const double t = static_cast<double>(left);
    return 0.9 * share * -std::log(t) * t * sum * tests::flux(sun_of_texel(), 0);
}

// Rows say that all light reaches all of the box.
TEST(SunAhead, ThroughAnEvenBoxIsExactWhateverRowsSay) {
    for (const float sigma_t : {0.02f, 0.1f, 0.3f}) {
        const LitTestVolumes lit({even_box(sigma_t, 1)}, sun_of_texel());
        const double expected = exact(lit, 0, 1);
        EXPECT_NEAR(static_cast<double>(seen_at(lit, 0)), expected, 0.03 * expected) << sigma_t;
    }
}

TEST(SunAhead, ThroughTwoVolumesIsDimmedByBoth) {
    const LitTestVolumes lit({even_box(0.12f, 1), even_box(0.08f, 1)}, sun_of_texel());
    const double expected = exact(lit, 0, 0.6) + exact(lit, 1, 0.4);
    EXPECT_NEAR(static_cast<double>(seen_at(lit, 0)), expected, 0.02 * expected);
}

// A surface behind the volume hides the sun: rows know, the density does not.
TEST(SunAhead, OfPlacesInShadowStaysDark) {
    const LitTestVolumes dark({even_box(0.1f, 0)}, sun_of_texel());
    EXPECT_EQ(seen_at(dark, 0), 0);
    const LitTestVolumes dim({even_box(0.1f, 1e-3f)}, sun_of_texel());
    const LitTestVolumes dimmer({even_box(0.1f, 0.5e-3f)}, sun_of_texel());
    EXPECT_LT(seen_at(dimmer, 0), 0.6f * seen_at(dim, 0));
}

// Rows are means over directions and between nodes: up to twice too dark they change nothing.
TEST(SunAhead, OfPlacesInLightIsWhatDensitySays) {
    const LitTestVolumes whole({even_box(0.1f, 1)}, sun_of_texel());
    const LitTestVolumes half({even_box(0.1f, 0.51f)}, sun_of_texel());
    for (const double degrees : {0.0, 12.5, 20.0, 90.0, 180.0}) {
        EXPECT_EQ(seen_at(whole, degrees), seen_at(half, degrees)) << degrees;
        EXPECT_GT(seen_at(whole, degrees), 0) << degrees;
    }
}

// No edge is seen around the sun: relative to its neighbours no step stands out.
TEST(SunAhead, NothingJumpsAsRaysTurnAway) {
    const LitTestVolumes lit({even_box(0.2f, 1)}, sun_of_texel());
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
