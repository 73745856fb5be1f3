#include "formats/image/chromaticities.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace opaline::formats {
namespace {

// The matrices that the Academy (ACES 1.3, AP1 and AP0 by Bradford's adaptation), the ITU (BT.2087)
// and SMPTE (RP 431-2 primaries with D65) print.
TEST(Chromaticities, MatricesAreThePublishedOnes) {
    struct Row {
        Chromaticities from;
        std::array<double, 9> expected;  // row after row
    };
    const Row rows[]{
        {{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f},
         {1.70505, -0.62179, -0.08326, -0.13026, 1.14080, -0.01055, -0.02400, -0.12897, 1.15297}},
        {{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f},
         {2.52169, -1.13413, -0.38756, -0.27648, 1.37272, -0.09624, -0.01538, -0.15298, 1.16835}},
        {{0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f},
         {1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187}},
        {{0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.3127f, 0.329f},
         {1.2249, -0.2249, 0, -0.0420, 1.0420, 0, -0.0197, -0.0786, 1.0983}}};
    for (const Row& row : rows) {
        const auto matrix = to_rec709(row.from);
        ASSERT_TRUE(matrix);
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR((*matrix)[int(i % 3)][int(i / 3)], row.expected[i], 2e-4)
                << row.from[0] << " " << i;
        }
    }
}

TEST(Chromaticities, ImpossibleOnesHaveNoMatrix) {
    EXPECT_FALSE(to_rec709({}));
    EXPECT_FALSE(to_rec709({0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(to_rec709({nan, nan, nan, nan, nan, nan, nan, nan}));
}

}  // namespace
}  // namespace opaline::formats
