#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"
#include "runtime/clouds/sky_light.h"

// The lights that a command line names, as cloud layers take them.

namespace opaline::runtime {
namespace {

using std::numbers::pi;

TEST(BuiltinSkies, SunIsOneOfIrradiancePi) {
    const auto light = bake::make_environment("sun:30,40");
    ASSERT_TRUE(light);
    const SkyLight sky = split_sky(*light, rotation_about_y(1));
    ASSERT_EQ(sky.suns.size(), 1u);
    EXPECT_NEAR(sky.suns[0].irradiance.g, pi, 1e-4);
    EXPECT_NEAR(sky.suns[0].direction.y, std::sin(40 * pi / 180), 1e-6);
    EXPECT_NEAR(std::atan2(sky.suns[0].direction.x, sky.suns[0].direction.z), 30 * pi / 180 + 1,
                1e-5);
    EXPECT_EQ(sky.irradiance, formats::Rgb{});
    EXPECT_TRUE(split_sky(*bake::make_environment("sun:30,-40"), {}).suns.empty());
}

// make_sky scales sun and sky to the irradiance pi on a horizontal plane.
TEST(BuiltinSkies, SunAndSkyOfAClearDayGiveTheIrradianceThatTheirMakerStates) {
    for (const char* name : {"sky:3,35", "sky:2,80", "sky:6,5"}) {
        const auto light = bake::make_environment(name);
        ASSERT_TRUE(light);
        const SkyLight sky = split_sky(*light, {});
        ASSERT_EQ(sky.suns.size(), 1u) << name;
        EXPECT_EQ(sky.sun_discs.size(), 1u);
        const formats::Rgb whole =
            sky.irradiance + sky.suns[0].direction.y * sky.suns[0].irradiance;
        EXPECT_NEAR(formats::luminance(whole), pi, 2e-3 * pi) << name;
        EXPECT_GT(formats::luminance(sky.horizon), 0);
    }
}

TEST(BuiltinSkies, WhiteAndStudioHaveNoSun) {
    const SkyLight white = split_sky(*bake::make_environment("white"), {});
    EXPECT_TRUE(white.suns.empty());
    EXPECT_NEAR(white.irradiance.r, pi, 1e-3);
    EXPECT_NEAR(white.horizon.b, 1, 1e-5);
    EXPECT_TRUE(split_sky(*bake::make_environment("studio"), {}).suns.empty());
}

}  // namespace
}  // namespace opaline::runtime
