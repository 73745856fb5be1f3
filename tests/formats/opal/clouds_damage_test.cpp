// Cloud layers whose bytes are not as they were written: nothing may be read out of bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/formats/opal/cloud_fixture.h"
#include "tests/formats/opal/section_damage.h"

namespace opaline::formats {
namespace {

TEST(CloudsDamage, EveryTruncationIsRefused) {
    tests::expect_truncations_refused(tests::make_cloud_asset());
}

TEST(CloudsDamage, EveryTruncationOfTheSectionIsRefused) {
    tests::expect_section_truncations_refused(tests::make_cloud_asset(), kClouSection);
}

TEST(CloudsDamage, EveryFlippedByteIsFoundByTheFullCheck) {
    tests::expect_flipped_bytes_found(tests::make_cloud_asset(), kClouSection);
}

// The sum of everything that a runtime would use; the address sanitizer watches.
double sum_of_layers(const CloudsView& clouds) {
    double sum = 0;
    for (const LayerRecord& layer : clouds.records) {
        for (const std::uint16_t code : clouds.thickness_of(layer)) {
            sum += double{layer.highest} * code / 65535;
        }
        for (const auto& color : clouds.ground_of(layer))
            sum += color[0] + color[1] + color[2];
        for (std::size_t band = 0; band < 3; ++band) {
            const LayerTables t = tables_of(clouds, layer, band);
            for (const auto part :
                 {t.log_phase, t.glow, t.t1, t.t_ms, t.r1, t.mean_t, t.reflected, t.transmitted}) {
                for (const float value : part)
                    sum += double{value};
            }
            sum += double{layer.band[band].rest_kappa() * layer.highest};
        }
    }
    return sum;
}

TEST(CloudsDamage, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    for (const bool has_all : {true, false}) {
        double last = 0;
        const auto [refused, accepted, refused_for_values] = tests::forge_section(
            tests::make_cloud_asset({.has_peak = has_all, .has_radiance = has_all}), kClouSection,
            48 + sizeof(LayerRecord),
            [&](const AssetView& asset) { last = sum_of_layers(asset.clouds); });
        EXPECT_TRUE(std::isfinite(last));  // of the last byte, which is padding or of a sound table
        EXPECT_GT(refused, 250u);
        EXPECT_GT(accepted, 250u);
        EXPECT_GT(refused_for_values, 50u);
    }
}

// All counts at once, as no single bit makes them.
TEST(CloudsDamage, CountsWhoseProductsOverflowAreRefused) {
    const std::vector<std::uint32_t> huge{0xffffffffu, 0x80000000u, 0x10000u, 7u};
    for (const std::uint32_t a : huge) {
        for (const std::uint32_t b : huge) {
            Asset asset = tests::make_cloud_asset();
            asset.clouds.records[0].frames = a;
            asset.clouds.records[0].columns = b;
            EXPECT_NE(tests::fault_of(asset, Checks::structure), "") << a << ' ' << b;
            asset = tests::make_cloud_asset();
            LayerRecord& layer = asset.clouds.records[0];
            layer.radiance_depths = layer.radiance_modes = a;
            layer.radiance_cosines = b;
            EXPECT_NE(tests::fault_of(asset, Checks::structure), "") << a << ' ' << b;
            asset = tests::make_cloud_asset();
            asset.clouds.records[0].flux_depths = a;
            asset.clouds.records[0].flux_cosines = b;
            EXPECT_NE(tests::fault_of(asset, Checks::structure), "") << a << ' ' << b;
            asset = tests::make_cloud_asset();
            asset.clouds.records[0].glow_angles = a;
            asset.clouds.records[0].glow_events = b;
            EXPECT_NE(tests::fault_of(asset, Checks::structure), "") << a << ' ' << b;
        }
        Asset asset = tests::make_cloud_asset();
        asset.clouds.records[0].phase_angles = a;
        EXPECT_NE(tests::fault_of(asset, Checks::structure), "") << a;
    }
}

}  // namespace
}  // namespace opaline::formats
