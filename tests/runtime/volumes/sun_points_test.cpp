// How much of a sun's light reaches the points at which volumes know it.
#include "runtime/volumes/sun_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/volumes/volume_lattice.h"
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

}  // namespace
}  // namespace opaline::runtime
