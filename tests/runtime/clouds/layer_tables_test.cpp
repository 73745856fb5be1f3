#include "runtime/clouds/layer_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bake/physics/slab/low_orders.h"
#include "runtime/clouds/slab_source.h"
#include "tests/support/cloud_layers.h"

// What the runtime reads from a file's tables is what the baker's own readers say.

namespace opaline::runtime {
namespace {

const formats::Clouds& table_clouds() {
    static const formats::Clouds clouds = test::make_test_clouds(test::even_test_layer());
    return clouds;
}
std::array<formats::LayerTables, 3> band_tables() {
    const formats::CloudsView view = table_clouds().view();
    return {tables_of(view, view.records[0], 0), tables_of(view, view.records[0], 1),
            tables_of(view, view.records[0], 2)};
}
bake::SlabMedium table_medium() {
    return {bake::table_moments(bake::split_peak(test::test_phase({}), 0.08).rest, 400), 1.0};
}

TEST(SingleScattering, IsTheClosedFormOverWhatTheViewTakes) {
    for (const double depth : {1e-9, 1e-3, 0.4, 3.0, 80.0, 1e5}) {
        for (const double light : {1e-3, 0.3, 0.5, 1.0}) {
            for (const double view : {1e-3, 0.2999, 0.3, 0.5, 1.0}) {
                const double taken = -std::expm1(-depth / view);
                const auto d = static_cast<float>(depth), l = static_cast<float>(light),
                           v = static_cast<float>(view);
                EXPECT_NEAR(static_cast<double>(reflected_source(d, l, v)),
                            bake::reflected_once(depth, light, view) / taken, 2e-5)
                    << depth << " " << light << " " << view;
                EXPECT_NEAR(static_cast<double>(transmitted_source(d, l, v)),
                            bake::transmitted_once(depth, light, view) / taken, 2e-4)
                    << depth << " " << light << " " << view;
            }
        }
    }
}

TEST(SingleScattering, IsFiniteForEveryDepth) {
    const float endless = std::numeric_limits<float>::infinity();
    EXPECT_EQ(reflected_source(0, 0.5f, 0.5f), 1);
    EXPECT_EQ(transmitted_source(0, 0.5f, 0.5f), 1);
    EXPECT_FLOAT_EQ(reflected_source(endless, 0.5f, 0.5f), 0.5f);
    EXPECT_EQ(transmitted_source(endless, 0.5f, 0.5f), 0);
    // X e^-X at X = 2.
    EXPECT_NEAR(transmitted_source(1, 0.5f, 0.5f) * taken_share(2), 0.270671f, 1e-6f);
}

TEST(ScatteringAngle, IsExactAheadAndBehind) {
    const formats::Vec3 sun{0, 1, 0};
    const auto ray = [](double angle) {
        return formats::Vec3{static_cast<float>(std::sin(angle)),
                             static_cast<float>(std::cos(angle)), 0};
    };
    for (const double angle : {1e-4, 0.01, 1.0, 2.5, 3.14}) {
        EXPECT_NEAR(static_cast<double>(scattering_angle(sun, ray(angle))), angle, 1e-6);
    }
    EXPECT_NEAR(scattering_angle(sun, {0, -1, 0}), std::numbers::pi_v<float>, 1e-6f);
}

TEST(LayerTables, RestOfThePhaseFunctionIsThatOfTheSplit) {
    const auto tables = band_tables();
    const bake::PeakSplit split = bake::split_peak(test::test_phase({}), 0.08);
    const formats::LayerRecord& record = table_clouds().records[0];
    const auto rest = [&](float angle, float events) {
        return rest_phase(tables[1], record, 1, angle, phase_coordinate(std::max(angle, 0.08f)),
                          events, peak_mean_square(tables[1], record));
    };
    for (const double angle : {0.09, 0.3, 1.5, 2.45, 3.0, 3.1415}) {
        EXPECT_NEAR(static_cast<double>(rest(static_cast<float>(angle), 0)) /
                        bake::eval_table(split.rest, angle),
                    1, 0.02);
    }
    EXPECT_EQ(rest(0.07f, 0), 0);
    // Scattering by the peak besides blurs the edge, and changes nothing far from it.
    EXPECT_NEAR(rest(0.0799f, 8) / rest(0.0801f, 8), 1, 0.02f);
    EXPECT_NEAR(rest(0.5f, 8) / rest(0.5f, 0), 1, 1e-4f);
}

TEST(LayerTables, MeanSquareOfThePeakIsItsIntegral) {
    const bake::PeakSplit split = bake::split_peak(test::test_phase({}), 0.08);
    bake::AngularTable square = split.peak;
    for (std::size_t i = 0; i < square.angle.size(); ++i) {
        square.value[i] *= square.angle[i] * square.angle[i];
    }
    EXPECT_NEAR(static_cast<double>(peak_mean_square(band_tables()[1], table_clouds().records[0])) /
                    bake::integrate_table(square),
                1, 0.02);
}

TEST(LayerTables, SharesOfFluxAreTheBakersAndAddUpToOne) {
    const auto tables = band_tables();
    const test::TestLayer layer = test::even_test_layer();
    const bake::SlabTable slab = bake::make_slab_table(table_medium(), layer.flux);
    for (const double depth : {0.0, 0.01, 0.5, 4.0, 60.0, 1e9}) {
        for (const double cosine : {1e-3, 0.1, 0.6, 1.0}) {
            const FluxShares shares =
                flux_shares(tables[1], table_clouds().records[0], static_cast<float>(depth),
                            static_cast<float>(cosine));
            EXPECT_NEAR(shares.straight + shares.across + shares.reflected, 1, 1e-6f);
            EXPECT_GE(shares.across, shares.once);
            const bake::OrderShares expected = bake::eval_slab_table(slab, depth, cosine);
            const double all = expected.transmitted[0] + expected.transmitted[1] +
                               expected.transmitted[2] + expected.transmitted[3];
            EXPECT_NEAR(static_cast<double>(shares.straight + shares.across), all, 1e-5);
        }
        EXPECT_NEAR(static_cast<double>(mean_transmittance(tables[1], static_cast<float>(depth))),
                    bake::eval_mean_transmittance(slab, depth), 1e-5);
    }
}

TEST(LayerTables, RadianceOfASunIsTheBakersTable) {
    const test::TestLayer layer = test::even_test_layer();
    const bake::RadianceTable slab = bake::make_radiance_table(table_medium(), layer.radiance, 16);
    for (const double light : {1.0, 0.55, 0.08}) {
        const SunTable sun =
            make_sun_table(band_tables(), table_clouds().records[0], static_cast<float>(light));
        for (const double depth : {0.2, 3.0, 40.0}) {
            for (const double view : {1.0, 0.4, 0.02}) {
                for (const double azimuth : {0.0, 1.1, 3.14}) {
                    for (const bool transmitted : {false, true}) {
                        const auto d = static_cast<float>(depth);
                        const formats::Rgb seen = multiple_source(
                            sun, {d, d, d}, static_cast<float>(light), static_cast<float>(view),
                            static_cast<float>(std::cos(azimuth)), transmitted);
                        const double expected = bake::eval_radiance_table(slab, depth, light, view,
                                                                          azimuth, transmitted);
                        EXPECT_NEAR(static_cast<double>(seen.g) * -std::expm1(-depth / view),
                                    std::max(0.0, expected), 1e-5 + 1e-3 * expected)
                            << light << " " << depth << " " << view << " " << azimuth;
                    }
                }
            }
        }
    }
}

TEST(LayerTables, GlowAndDiscOfTheSunAreAllThatGoesStraight) {
    // The integral of W_F over the sphere is 1 - e^-u; with the disc's e^-u it is all.
    const auto tables = band_tables();
    const formats::LayerRecord& record = table_clouds().records[0];
    for (const double events : {0.05, 0.5, 2.0, 5.0}) {
        constexpr int kSteps = 4000;
        const double end = 4 * static_cast<double>(record.peak_angle), step = end / kSteps;
        double glow = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = (i + 0.5) * step;
            glow += 2 * std::numbers::pi * std::sin(angle) * step *
                    static_cast<double>(forward_glow(tables[1], record, static_cast<float>(angle),
                                                     static_cast<float>(events)));
        }
        // The table has 48 angles and 16 depths, and ends at four times the peak's angle.
        EXPECT_NEAR(glow + std::exp(-events), 1, 0.03) << events;
    }
    EXPECT_EQ(forward_glow(tables[1], record, 0, 13), 0);
    EXPECT_EQ(forward_glow(tables[1], record, 1, 1), 0);
}

}  // namespace
}  // namespace opaline::runtime
