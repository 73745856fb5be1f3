// How much of a sun's light reaches the points at which volumes know it.
// Light of a sun straight ahead comes through what the ray itself meets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "formats/opal/cubemap.h"
#include "formats/opal/phase_table.h"
#include "runtime/volumes/sun_light.h"
#include "runtime/volumes/volume_lattice.h"
#include "runtime/volumes/volume_march.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/lit_volumes.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::LitTestVolumes;
using test::TestVolume;

constexpr std::uint32_t kSideTexel = 3 * 8 + 3;  // toward +x, a little up and aside

// Even, of 3 x 3 x 3 bricks; its light is white and rows let all of it through.
TestVolume even_body(Rgb sigma_t, std::uint32_t spacing) {
    TestVolume volume;
    volume.extent = {3, 3, 3};
    volume.spacing = spacing;
    volume.single_terms = 4;
    test::scatter_forward(volume, 0.5);
    volume.sigma_t = sigma_t;
    return volume;
}

LightVector texel_sun() {
    return test::texel_light(test::kSize, kSideTexel, {1000, 1000, 1000});
}

// The share that reaches a point of the brick in the middle, whose way out is through the face +x.
Rgb share_at(const LitTestVolumes& lit, std::size_t volume, std::size_t point) {
    const double sent = tests::flux(texel_sun(), 0);
    const std::uint32_t brick = lit.view.table[lit.view.records[volume].first_cell + 13];
    return static_cast<float>(1 / sent) * lit.light.sun_coefficients(volume, brick, point)[0];
}

TEST(SunPoints, ReceiveWhatBeerAndLambertSayInEachBand) {
    const Vec3 sun =
        formats::texel_direction(test::kSize, kSideTexel / 64, kSideTexel / 8 % 8, kSideTexel % 8);
    ASSERT_GT(sun.x, 0.9f);
    for (const std::uint32_t spacing : {1u, 2u, 4u, 8u}) {
        const LitTestVolumes lit({even_body({0.02f, 0.05f, 0.1f}, spacing)}, texel_sun());
        const std::size_t side = lit.light.part[0].sun_boxes + 1;
        ASSERT_EQ(side, std::min(16 / spacing, 8u) + 1);
        for (std::size_t i = 0; i < side; ++i) {
            // Density falls to 0 from the last voxel, 23, to the face at 24.
            const double x = 8 + 8.0 * static_cast<double>(i) / static_cast<double>(side - 1);
            const std::size_t middle = (side - 1) / 2;
            const std::size_t point = (middle * side + middle) * side + i;
            const double way = (23.5 - x) / static_cast<double>(sun.x);
            const Rgb share = share_at(lit, 0, point);
            EXPECT_NEAR(share.r, std::exp(-0.02 * way), 0.01) << spacing << ", " << i;
            EXPECT_NEAR(share.g, std::exp(-0.05 * way), 0.02) << spacing << ", " << i;
            EXPECT_NEAR(share.b, std::exp(-0.1 * way), 0.03) << spacing << ", " << i;
        }
    }
}

TEST(SunPoints, BehindAnotherVolumeReceiveWhatBothLeave) {
    const LitTestVolumes one({even_body({0.05f, 0.05f, 0.05f}, 4)}, texel_sun());
    const LitTestVolumes two(
        {even_body({0.05f, 0.05f, 0.05f}, 4), even_body({0.1f, 0.1f, 0.1f}, 8)}, texel_sun());
    for (std::size_t point = 0; point < 125; ++point) {
        const float alone = share_at(one, 0, point).g, both = share_at(two, 0, point).g;
        EXPECT_NEAR(both, alone * alone * alone, 0.01) << point;
    }
}

// Surfaces stand before the sun: the density does not know, rows do.
TEST(SunPoints, InTheShadowOfSurfacesReceiveNoMoreThanTwiceWhatRowsSay) {
    for (const float reach : {0.0f, 0.1f}) {
        TestVolume volume = even_body({0.01f, 0.01f, 0.01f}, 4);
        volume.rows = [reach](formats::NodeVoxel) {
            return std::vector<formats::SparseRow>{test::constant_row(test::kSize, reach)};
        };
        const LitTestVolumes lit({volume}, texel_sun());
        ASSERT_EQ(lit.view.records[0].bands, 1u);
        for (std::size_t point = 0; point < 125; ++point) {
            EXPECT_NEAR(share_at(lit, 0, point).g, 2 * reach, 0.01f) << reach;  // of some .85
        }
    }
}

// Densities up to the largest number are legal, though their sums are none.
TEST(SunPoints, BehindDensitiesWhoseSumOverflowsReceiveNothing) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    TestVolume volume = even_body({1, 1, 1}, 4);
    volume.density = [](float, float, float) { return 3e38f; };
    const LitTestVolumes lit({volume}, texel_sun());
    const std::size_t side = lit.light.part[0].sun_boxes + 1;
    for (std::size_t point = 0; point < side * side * side; ++point) {
        EXPECT_LT(share_at(lit, 0, point).g, 1e-6f) << point;
    }
}

// A file may say so; with a sun every volume's density is asked for.
TEST(SunPoints, AVolumeOfBricksWithoutCellsHoldsNothing) {
    LitTestVolumes lit({even_body({0.05f, 0.05f, 0.05f}, 4), even_body({0.1f, 0.1f, 0.1f}, 8)},
                       texel_sun());
    const LitTestVolumes alone({even_body({0.05f, 0.05f, 0.05f}, 4)}, texel_sun());
    std::vector<formats::VolumeRecord> records(lit.view.records.begin(), lit.view.records.end());
    records[1].extent[0] = 0;
    lit.view.records = records;
    const VolumeLight light = relight_volumes(lit.view, texel_sun());
    const std::uint32_t brick = lit.view.table[records[0].first_cell + 13];
    for (std::size_t point = 0; point < 125; ++point) {
        EXPECT_EQ(light.sun_coefficients(0, brick, point)[0],
                  alone.light.sun_coefficients(0, brick, point)[0]);
    }
}

// Else a seam is seen where bricks meet.
// Also where no brick stands beyond an edge of both, whatever side of it the sun is on.
TEST(SunPoints, OnFacesBetweenBricksAreTheSameInBoth) {
    TestVolume volume = even_body({0.1f, 0.1f, 0.1f}, 4);
    volume.density = [](float x, float y, float z) {
        return x >= 16 && y >= 16 ? 0.0f : 0.5f + 0.5f * std::sin(x + 2 * y + 3 * z);
    };
    int met = 0;
    for (const std::uint32_t texel : {27u, 28u, 35u, 36u}) {
        const LitTestVolumes lit({volume},
                                 test::texel_light(test::kSize, texel, {1000, 1000, 1000}));
        const auto lattice = make_lattice(lit.view, lit.view.records[0]);
        for (std::int32_t z = 0; z < 3; ++z) {
            for (std::int32_t x = 0; x < 2; ++x) {
                const std::uint32_t low = lattice->brick({x, 1, z}),
                                    high = lattice->brick({x + 1, 1, z});
                if (low == formats::kNoBrick || high == formats::kNoBrick) continue;
                ++met;
                for (std::size_t row = 0; row < 25; ++row) {
                    EXPECT_EQ(lit.light.sun_coefficients(0, low, 5 * row + 4)[0],
                              lit.light.sun_coefficients(0, high, 5 * row)[0]);
                }
            }
        }
        EXPECT_EQ(lattice->brick({2, 2, 1}), formats::kNoBrick);
    }
    EXPECT_GT(met, 12);
}

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
