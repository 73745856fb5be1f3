#include "bake/lights/daylight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

using std::numbers::pi;

// [Preetham1999] A.2: absolute luminance of the zenith [kcd/m^2].
double published_zenith_luminance(double turbidity, double sun_zenith) {
    const double chi = (4.0 / 9.0 - turbidity / 120.0) * (pi - 2.0 * sun_zenith);
    return (4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
}

TEST(PerezSky, ZenithHasThePublishedLuminance) {
    for (const double turbidity : {2.0, 4.0, 8.0}) {
        for (const double sun_zenith : {0.1, 0.6, 1.2}) {
            const PerezSky sky = make_perez_sky(turbidity, sun_zenith);
            const double wanted = published_zenith_luminance(turbidity, sun_zenith);
            EXPECT_NEAR(eval_perez_sky(sky, 1.0, sun_zenith)[1], wanted, 1e-9 * wanted);
        }
    }
}

TEST(PerezSky, IsBrightestAroundTheSun) {
    const double sun_zenith = 0.9;
    const PerezSky sky = make_perez_sky(3.0, sun_zenith);
    const double height = std::cos(sun_zenith);
    EXPECT_GT(eval_perez_sky(sky, height, 0.05)[1], 3 * eval_perez_sky(sky, height, 1.5)[1]);
}

TEST(Sun, IlluminanceOnTheGroundIsThatOfAClearDay) {
    // 128 klx outside the atmosphere; measured clear noon suns give about 90 to 110 klx.
    const double noon = sun_irradiance(2.0, 0.0)[1];
    EXPECT_GT(noon, 90.0);
    EXPECT_LT(noon, 115.0);
    EXPECT_LT(sun_irradiance(2.0, 1.4)[1], 0.6 * noon);
    EXPECT_LT(sun_irradiance(6.0, 0.0)[1], 0.8 * noon);
}

TEST(Sun, ChromaticityAtNoonIsThatOfSunlight) {
    // Direct noon sunlight lies near 5000 to 5600 K: x 0.33 to 0.35, y 0.34 to 0.36.
    const Xyz xyz = sun_irradiance(2.0, 0.3);
    const double sum = xyz[0] + xyz[1] + xyz[2];
    EXPECT_NEAR(xyz[0] / sum, 0.340, 0.012);
    EXPECT_NEAR(xyz[1] / sum, 0.350, 0.012);
}

TEST(Rec709, WhiteOfD65IsEqualInAllBandsAndRedIsItsPrimary) {
    const auto rgb = formats::rec709_of_xyz({0.95047, 1.0, 1.08883}),
               red = formats::rec709_of_xyz({0.4124, 0.2126, 0.0193});
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_NEAR(rgb[band], 1.0, 1e-3);
        EXPECT_NEAR(red[band], band == 0 ? 1.0 : 0.0, 1e-3);
    }
}

}  // namespace
}  // namespace opaline::bake
