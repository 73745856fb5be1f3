#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"
#include "bake/lights/daylight.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

using std::numbers::pi;

double luminance_of(const Rgb& c) {
    return 0.2126 * double{c.r} + 0.7152 * double{c.g} + 0.0722 * double{c.b};
}

Environment make(const std::string& name) {
    const auto made = make_environment(name);
    EXPECT_TRUE(made) << name;
    return made ? *made : Environment{};
}

/// Luminance of the light on a plane facing `normal`, by summation over a fine map.
double irradiance(const Environment& environment, Vec3 normal) {
    constexpr std::uint32_t kWidth = 2048, kHeight = 1024;
    const formats::Image image = rasterise_lat_long(environment, kWidth, kHeight);
    double sum = 0;
    for (std::uint32_t row = 0; row < kHeight; ++row) {
        const double solid_angle = lat_long_pixel_solid_angle(kWidth, kHeight, row);
        const double theta = pi * (row + 0.5) / kHeight;
        for (std::uint32_t column = 0; column < kWidth; ++column) {
            const double phi = pi * (2 * (column + 0.5) / kWidth - 1);
            const double cosine = std::sin(theta) * std::cos(phi) * double{normal.x} +
                                  std::cos(theta) * double{normal.y} +
                                  std::sin(theta) * std::sin(phi) * double{normal.z};
            sum += solid_angle * std::max(cosine, 0.0) *
                   luminance_of(image.pixel[std::size_t{row} * kWidth + column]);
        }
    }
    return sum;
}

TEST(BuiltinEnvironment, WhiteLightsEveryPlaneWithPi) {
    const Environment white = make("white");
    for (const Vec3 normal : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0.6f, 0, -0.8f}}) {
        EXPECT_NEAR(irradiance(white, normal), pi, 1e-5);
    }
}

TEST(BuiltinEnvironment, SunHasIrradiancePiAndHalfADegree) {
    for (const char* name : {"sun:0,90", "sun:40,30", "sun:-170,2"}) {
        const Environment sun = make(name);
        EXPECT_TRUE(sun.pixel.empty());
        ASSERT_EQ(sun.discs.size(), 1u);
        const auto& disc = sun.discs[0];
        EXPECT_NEAR(2 * double{disc.angular_radius} * 180 / pi, 0.53, 1e-6);
        EXPECT_NEAR(double{disc.radiance.g} * formats::disc_solid_angle(disc.angular_radius), pi,
                    1e-5);
        EXPECT_NEAR(irradiance(sun, disc.direction), pi, 2e-5 * pi);
    }
}

TEST(BuiltinEnvironment, AzimuthTurnsFromPlusZToPlusX) {
    const auto towards = [](const char* name) { return make(name).discs[0].direction; };
    const auto expect = [](Vec3 found, Vec3 wanted) {
        EXPECT_NEAR(found.x, wanted.x, 1e-7);
        EXPECT_NEAR(found.y, wanted.y, 1e-7);
        EXPECT_NEAR(found.z, wanted.z, 1e-7);
    };
    expect(towards("sun:0,0"), {0, 0, 1});
    expect(towards("sun:90,0"), {1, 0, 0});
    expect(towards("sun:180,0"), {0, 0, -1});
    expect(towards("sun:12,90"), {0, 1, 0});
    expect(towards("sun:0,-90"), {0, -1, 0});
}

TEST(BuiltinEnvironment, SkyGivesAHorizontalWhiteSurfaceLuminanceOne) {
    for (const char* name : {"sky:1.7,90", "sky:3,35", "sky:6,20", "sky:10,3"}) {
        EXPECT_NEAR(irradiance(make(name), {0, 1, 0}) / pi, 1, 2e-3) << name;
    }
}

TEST(BuiltinEnvironment, SkyIsFiniteAndNotNegativeOverItsWholeRange) {
    for (const double turbidity : {1.7, 4.0, 10.0}) {
        for (const double elevation : {1e-3, 0.5, 10.0, 45.0, 89.9, 90.0}) {
            const Environment sky =
                make("sky:" + std::to_string(turbidity) + "," + std::to_string(elevation));
            ASSERT_EQ(sky.discs.size(), 1u);
            const Rgb& disc = sky.discs[0].radiance;
            ASSERT_TRUE(std::isfinite(disc.r + disc.g + disc.b) && disc.b >= 0);
            for (const Rgb& c : sky.pixel) {
                ASSERT_TRUE(c.r >= 0 && c.g >= 0 && c.b >= 0);
                ASSERT_TRUE(std::isfinite(c.r + c.g + c.b));
            }
        }
    }
}

TEST(BuiltinEnvironment, LowSunIsRedderThanHighSunAndZenithBluerThanHorizon) {
    const auto redness = [](const Rgb& c) { return c.r / c.b; };
    const Environment low = make("sky:3,5"), high = make("sky:3,60");
    EXPECT_GT(redness(low.discs[0].radiance), 1.5f * redness(high.discs[0].radiance));
    // Away from the sun, whose azimuth is -40 degrees.
    const Vec3 horizon = direction_of(140, 2), zenith = direction_of(0, 90);
    EXPECT_GT(redness(sample_map(high, horizon)), 1.2f * redness(sample_map(high, zenith)));
}

TEST(BuiltinEnvironment, StudioIsBoundedAndBrightestAtTheKeyLight) {
    const Environment studio = make("studio");
    float brightest = 0;
    for (const Rgb& c : studio.pixel) {
        ASSERT_TRUE(c.r >= 0 && c.r <= 15 && c.g >= 0 && c.g <= 15 && c.b >= 0 && c.b <= 15);
        brightest = std::max({brightest, c.r, c.g, c.b});
    }
    EXPECT_GT(brightest, 5);
    // The key stands at the left front: it lights that side most.
    EXPECT_GT(irradiance(studio, direction_of(-44, 0)), irradiance(studio, direction_of(64, 0)));
}

TEST(BuiltinEnvironment, MalformedNamesAreUsageErrorsThatListTheForms) {
    for (const char* name :
         {"sun", "sun:", "sun:1", "sun:1,2,3", "sun:1,91", "sun:inf,0", "sky", "sky:1.6,10",
          "sky:11,10", "sky:3,0", "white:1", "black:1", "studio:2", "moon"}) {
        const auto made = make_environment(name);
        ASSERT_FALSE(made) << name;
        EXPECT_EQ(made.error().kind, formats::ErrorKind::usage);
        EXPECT_THAT(made.error().diagnostics[0].remedy, testing::HasSubstr("sky:TURBIDITY,EL"));
    }
}

TEST(BuiltinEnvironment, FileNamedLikeALightIsOpenedByItsPath) {
    EXPECT_TRUE(is_builtin("white"));
    EXPECT_FALSE(is_builtin("./white"));
    EXPECT_FALSE(is_builtin("whiteout.exr"));
    const auto missing = open_environment("./white");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, formats::ErrorKind::bad_input);
}

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

double flux(const formats::Image& image) {
    double sum = 0;
    for (std::uint32_t row = 0; row < image.height; ++row) {
        for (std::uint32_t column = 0; column < image.width; ++column) {
            sum += double{image.pixel[std::size_t{row} * image.width + column].r} *
                   lat_long_pixel_solid_angle(image.width, image.height, row);
        }
    }
    return sum;
}

TEST(Rasterise, PixelSolidAnglesAddUpToTheSphere) {
    for (const std::uint32_t height : {1u, 2u, 7u, 512u}) {
        double sum = 0;
        for (std::uint32_t row = 0; row < height; ++row) {
            sum += 3 * lat_long_pixel_solid_angle(3, height, row);
        }
        EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12) << height;
    }
}

TEST(Rasterise, DiscKeepsItsFluxInAnyResolution) {
    for (const double radius : {0.0046, 0.3, 1.5}) {
        for (const double elevation : {30.0, 89.9, -90.0}) {
            Environment environment;
            environment.discs.push_back(
                {direction_of(33, elevation), static_cast<float>(radius), {2, 2, 2}});
            const double wanted = 2 * formats::disc_solid_angle(static_cast<float>(radius));
            for (const std::uint32_t height : {8u, 64u}) {
                EXPECT_NEAR(flux(rasterise_lat_long(environment, 2 * height, height)), wanted,
                            1e-5 * wanted)
                    << radius << " " << elevation << " " << height;
            }
        }
    }
}

TEST(Rasterise, MapOfTheSameShapeIsCopied) {
    const auto studio = make_environment("studio");
    ASSERT_TRUE(studio);
    const formats::Image image = rasterise_lat_long(*studio, studio->width, studio->height);
    EXPECT_EQ(image.pixel, studio->pixel);
}

TEST(Rasterise, CoarserMapKeepsTheMeanOverTheSphere) {
    const auto studio = make_environment("studio");
    ASSERT_TRUE(studio);
    const double fine = flux(rasterise_lat_long(*studio, studio->width, studio->height));
    EXPECT_NEAR(flux(rasterise_lat_long(*studio, 128, 64)), fine, 2e-3 * fine);
}

}  // namespace

}  // namespace opaline::bake
