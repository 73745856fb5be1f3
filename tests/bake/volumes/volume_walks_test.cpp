#include "bake/effects/volumes/volume_walks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

// Mean source radiance of all views at each node, and its parts, under even light L = 1.
struct Furnace {
    double once = 0, often = 0;  // means over nodes
    double rms = 0;              // of the differences of their sum from 1
};

Furnace measure(const formats::Volumes& volumes) {
    const formats::VolumeRecord& record = volumes.records.at(0);
    Furnace furnace;
    const double y0 = std::sqrt(1 / (4 * std::numbers::pi));
    for (std::uint32_t node = 0; node < record.node_count; ++node) {
        const double once =
            tests::integrate_row(volumes.rows, record, node * record.terms()) * y0 * y0;
        const double often =
            record.multiple_terms == 0
                ? 0
                : tests::integrate_row(volumes.rows, record, node * record.terms() + 1) *
                      (record.multiple_terms == 1 ? 1 : y0);
        furnace.once += once / record.node_count;
        furnace.often += often / record.node_count;
        furnace.rms += (once + often - 1) * (once + often - 1) / record.node_count;
    }
    furnace.rms = std::sqrt(furnace.rms);
    return furnace;
}

formats::Volumes bake(const formats::Volume& volume, const Knobs& knobs) {
    return tests::bake_volumes_of(tests::scene_of(volume), knobs);
}

Knobs coarse_knobs(std::uint32_t walks) {
    Knobs knobs = tests::small_knobs(Quality::preview, 2);
    knobs.set(kVolumeWalks, walks);
    return knobs;
}

class WhiteFurnace : public testing::TestWithParam<float> {};

TEST_P(WhiteFurnace, AVolumeThatAbsorbsNothingCannotBeSeenUnderEvenLight) {
    const float g = GetParam();
    const Furnace ball =
        measure(bake(tests::make_volume(tests::make_ball_grid(1, 0.1), 2, 1, g), coarse_knobs(64)));
    EXPECT_NEAR(ball.once + ball.often, 1, 0.01);
    EXPECT_GT(ball.often, 0.15);
    EXPECT_LT(ball.rms, 0.11);
}

INSTANTIATE_TEST_SUITE_P(MeanCosines, WhiteFurnace, testing::Values(-0.3f, 0.0f, 0.5f, 0.9f));

TEST(VolumeWalks, ThinMediaScatterTwiceInProportionToTheirDensity) {
    const auto often = [](float sigma) {
        return measure(bake(tests::make_volume(tests::make_ball_grid(1, 0.2), sigma, 1, 0),
                            coarse_knobs(2048)))
            .often;
    };
    EXPECT_NEAR(often(0.1f) / often(0.05f), 2, 0.12);
}

TEST(VolumeWalks, AColouredVolumeIsThreeGreyOnesWithTheSameNoise) {
    const formats::Volume grey = tests::make_volume(tests::make_ball_grid(1, 0.25), 2, 0.8f, 0.3f);
    formats::Volume coloured = grey;
    coloured.sigma_t = {2, 1, 3};
    coloured.albedo = {0.8f, 0.4f, 0.9f};
    const Knobs knobs = coarse_knobs(8);
    const formats::Volumes one = bake(grey, knobs), three = bake(coloured, knobs);
    const formats::VolumeRecord &a = one.records.at(0), &b = three.records.at(0);
    ASSERT_EQ(a.bands, 1u);
    ASSERT_EQ(b.bands, 3u);
    ASSERT_EQ(a.node_count, b.node_count);
    double difference = 0, size = 0;
    for (std::uint32_t row = 0; row < a.node_count * a.terms(); ++row) {
        const double grey_row = tests::integrate_row(one.rows, a, row);
        const double red_row = tests::integrate_row(three.rows, b, row, 0);
        difference += (grey_row - red_row) * (grey_row - red_row);
        size += grey_row * grey_row;
    }
    // What is quantised differs, and how far rows are smoothed, which other bands decide too.
    EXPECT_LT(std::sqrt(difference / size), 0.03);
}

// Light of the first row at each node under even light, band after band.
std::vector<std::array<double, 3>> even_light(const formats::Volumes& volumes) {
    const formats::VolumeRecord& record = volumes.records.at(0);
    std::vector<std::array<double, 3>> light;
    for (std::uint32_t node = 0; node < record.node_count; ++node) {
        std::array<double, 3>& own = light.emplace_back();
        for (std::uint32_t band = 0; band < 3; ++band) {
            own[band] = tests::integrate_row(volumes.rows, record, node * record.terms() + 1, band);
        }
    }
    return light;
}

// Skim milk: its bands differ by 2.7 in extinction, nothing absorbs. Two bakes with different
// random numbers differ by noise alone.
TEST(VolumeWalks, NoiseOfAWhiteBodyHasLittleColourThoughItsBandsDiffer) {
    formats::Volume milk = tests::make_volume(tests::make_ball_grid(1, 0.25), 1, 1, 0.9f);
    milk.sigma_t = {7, 12, 19};
    Knobs knobs = tests::knobs_for(Quality::draft);
    knobs.set(kVolumeSpacing, 1);
    knobs.set(kVolumeTerms, 1);
    knobs.set(kVolumeWalks, 32);
    const auto one = even_light(bake(milk, knobs));
    knobs.seed = 1;
    const auto other = even_light(bake(milk, knobs));
    ASSERT_EQ(one.size(), other.size());
    std::array<double, 3> mean{};
    for (const auto& own : one) {
        for (std::size_t band = 0; band < 3; ++band) {
            mean[band] += own[band] / static_cast<double>(one.size());
        }
    }
    double colour = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const auto noise = [&](std::size_t band) {
            return (one[i][band] - other[i][band]) / (std::numbers::sqrt2 * mean[band]);
        };
        colour += std::pow(noise(0) - noise(2), 2) / static_cast<double>(one.size());
    }
    EXPECT_LT(std::sqrt(colour), 0.25);
}

}  // namespace
}  // namespace opaline::bake
