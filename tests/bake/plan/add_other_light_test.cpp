#include "bake/plan/add_other_light.h"

#include <gtest/gtest.h>

#include <numbers>

namespace opaline::bake {
namespace {

// E = 1, 2, 3 in the three bands of the first column.
OtherLight three_bands() {
    OtherLight light;
    light.add = [](const LitPoint&, std::uint32_t, std::span<float> rows) {
        for (std::size_t b = 0; b < 3; ++b) {
            rows[b * (rows.size() / 3)] += static_cast<float>(b + 1);
        }
        return std::uint64_t{7};
    };
    return light;
}

TEST(AddOtherLight, RowsTakeTheirShareOfEachBandAndGreyOnesTheLuminance) {
    const OtherLight light = three_bands();
    for (const std::uint32_t bands : {1u, 3u}) {
        std::vector<float> values(2 * bands * 6);
        const DenseRow row{values, 1, 2, bands};
        EXPECT_EQ(add_other_light(&light, {}, {{0, {0.5f, 0.5f, 0.5f}}, {1, {1, 1, 1}}}, row), 7u);
        for (std::uint32_t b = 0; b < bands; ++b) {
            const double e = bands == 1 ? 0.2126 + 2 * 0.7152 + 3 * 0.0722 : b + 1.0;
            EXPECT_NEAR(row.plane(0, b)[0], 0.5 * e, 1e-5);
            EXPECT_NEAR(row.plane(1, b)[0], e, 1e-5);
            EXPECT_EQ(row.plane(0, b)[1], 0);
        }
    }
}

TEST(AddOtherLight, TruthIsIrradianceOverPi) {
    std::vector<std::uint64_t> keys;
    const OtherLight::TrueIrradiance even = [&](const Receiver&, std::uint64_t key, std::uint32_t,
                                                std::span<double> irradiance) {
        keys.push_back(key);
        irradiance[0] += 2;
        return std::uint64_t{5};
    };
    TwoEstimates seen{{1.0}, {1.0}};
    EXPECT_EQ(add_true_other_light(even, {}, 4, 0.5, seen), 10u);
    EXPECT_NEAR(seen.first[0], 1 + std::numbers::inv_pi, 1e-12);
    EXPECT_NEAR(seen.second[0], 1 + std::numbers::inv_pi, 1e-12);
    ASSERT_EQ(keys.size(), 2u);
    EXPECT_NE(keys[0], keys[1]) << "two independent estimates";
}

}  // namespace
}  // namespace opaline::bake
