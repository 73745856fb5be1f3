#include "runtime/clouds/sky_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/clouds/map_peak.h"
#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::DistantDisc;
using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;
using tests::lat_long_map;

constexpr double kDegree = pi / 180;

Vec3 at_elevation(double degrees, double azimuth = 20) {
    const double e = degrees * kDegree, a = azimuth * kDegree;
    return {static_cast<float>(std::cos(e) * std::sin(a)), static_cast<float>(std::sin(e)),
            static_cast<float>(std::cos(e) * std::cos(a))};
}

// Rotation that turns +Y toward +Z: light falls toward the horizon.
Rotation tilt(double angle) {
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    return {{1, 0, 0}, {0, c, s}, {0, -s, c}};
}

// int over the upper hemisphere of radiance times cosine, of `radiance(direction)`, at even steps
// of squared height (which carry even cosine-weighted solid angle).
template <class Function>
Rgb horizontal_irradiance(const Function& radiance, int rings = 500) {
    double sum[3] = {};
    const int turns = 2 * rings;
    for (int j = 0; j < rings; ++j) {
        const double y = std::sqrt((j + 0.5) / rings), r = std::sqrt(1 - y * y);
        for (int i = 0; i < turns; ++i) {
            const double phi = 2 * pi * (i + 0.5) / turns;
            const Rgb c = radiance({static_cast<float>(r * std::cos(phi)), static_cast<float>(y),
                                    static_cast<float>(r * std::sin(phi))});
            sum[0] += c.r;
            sum[1] += c.g;
            sum[2] += c.b;
        }
    }
    const double scale = pi / (static_cast<double>(rings) * turns);
    return {static_cast<float>(scale * sum[0]), static_cast<float>(scale * sum[1]),
            static_cast<float>(scale * sum[2])};
}

Rgb whole_irradiance(const SkyLight& sky) {
    Rgb sum = sky.irradiance;
    for (const LayerSun& sun : sky.suns)
        sum = sum + sun.direction.y * sun.irradiance;
    return sum;
}

void expect_same(Rgb a, Rgb b, double relative) {
    EXPECT_NEAR(a.r, b.r, relative * b.r);
    EXPECT_NEAR(a.g, b.g, relative * b.g);
    EXPECT_NEAR(a.b, b.b, relative * b.b);
}

// A sky that is brighter near the sun, with a sun of `radius`, soft over one pixel.
Environment sky_with_sun(std::uint32_t width, Vec3 sun, double radius, float strength) {
    const double soft = 2 * pi / width;
    return lat_long_map(width, width / 2, [&](Vec3 d) {
        const double angle = 2 * std::asin(std::min(1.0, 0.5 * double{length(d - sun)}));
        const auto disc =
            static_cast<float>(std::clamp((radius - angle) / soft + 0.5, 0.0, 1.0)) * strength;
        const float aureole = 1 + 0.6f * std::exp(-3.0f * static_cast<float>(angle));
        return Rgb{0.4f * aureole + disc, 0.6f * aureole + 0.9f * disc, aureole + 0.7f * disc};
    });
}

// Of a disc above the horizon the irradiance facing it is pi sin^2 r times its radiance.
TEST(SkyLight, SunOfADiscHasItsDirectionAndIrradiance) {
    Environment light;
    light.discs.push_back({at_elevation(35), 0.1f, {2, 3, 4}});
    const Rotation rotation = rotation_about_y(0.7f);
    const SkyLight sky = split_sky(light, rotation);
    ASSERT_EQ(sky.suns.size(), 1u);
    const Vec3 expected = rotation.world_from_light(at_elevation(35));
    EXPECT_LT(length(sky.suns[0].direction - expected), 1e-6f);
    const double facing = pi * std::pow(std::sin(double{0.1f}), 2);
    EXPECT_NEAR(sky.suns[0].irradiance.g, 3 * facing, 1e-6);
    EXPECT_EQ(sky.suns[0].angular_radius, 0.1f);
    EXPECT_EQ(sky.irradiance, Rgb{});
    EXPECT_EQ(sky.horizon, Rgb{});
}

// A quarter of the sphere, the limit of a disc of 90 degrees whose centre lies on the horizon, has
// the first moment pi/2 (up + across). In general: against a dense sum.
TEST(SkyLight, DiscAcrossTheHorizonCountsWithThePartAbove) {
    for (const double elevation : {25.0, 10.0, 0.0, -10.0, -25.0}) {
        Environment light;
        light.discs.push_back({at_elevation(elevation, 90), 0.5f, {1, 1, 1}});
        const SkyLight sky = split_sky(light, {});
        ASSERT_EQ(sky.suns.size(), 1u);
        double up = 0, across = 0;
        constexpr int kSteps = 1000;
        for (int j = 0; j < kSteps; ++j) {
            const double y = (j + 0.5) / kSteps, r = std::sqrt(1 - y * y);
            for (int i = 0; i < kSteps; ++i) {
                const double phi = pi * (i + 0.5) / kSteps - pi / 2;
                const Vec3 d{static_cast<float>(r * std::cos(phi)), static_cast<float>(y),
                             static_cast<float>(r * std::sin(phi))};
                if (formats::sample_radiance(light, d).r == 0) continue;
                up += y;
                across += r * std::cos(phi);
            }
        }
        const double scale = pi / kSteps / kSteps;
        EXPECT_NEAR(sky.suns[0].irradiance.r * sky.suns[0].direction.y, scale * up, 2e-3);
        EXPECT_NEAR(sky.suns[0].irradiance.r * sky.suns[0].direction.x, scale * across, 2e-3);
    }
}

TEST(SkyLight, SetsContinuously) {
    Environment light;
    light.discs.push_back({{0, 1, 0}, 0.0046f, {1e4f, 1e4f, 1e4f}});
    const Environment map = sky_with_sun(512, {0, 1, 0}, 0.02, 500);
    for (const Environment& environment : {light, map}) {
        const bool is_map = !environment.pixel.empty();
        const double radius = is_map ? 0.02 : 0.0046;
        Rgb before = whole_irradiance(split_sky(environment, tilt(pi / 2 - 1.5 * radius)));
        const double whole = split_sky(environment, {}).suns.at(0).irradiance.g;
        bool has_set = false;
        const int steps = is_map ? 30 : 300;
        for (int i = 1; i <= steps; ++i) {
            const SkyLight sky =
                split_sky(environment, tilt(pi / 2 + (3.0 * i / steps - 1.5) * radius));
            const Rgb now = whole_irradiance(sky);
            EXPECT_NEAR(now.g, before.g, 0.3 * radius * whole + 0.01 * before.g);
            for (const LayerSun& sun : sky.suns)
                EXPECT_GT(sun.direction.y, 0);
            has_set = sky.suns.empty();
            before = now;
        }
        EXPECT_TRUE(has_set);
    }
}

TEST(SkyLight, KeepsTheStrongestDiscsAndAddsOthersToTheSky) {
    Environment light = lat_long_map(64, 32, [](Vec3) { return Rgb{1, 1, 1}; });
    for (const float strength : {1.0f, 3.0f, 2.0f}) {
        light.discs.push_back(
            {at_elevation(30, 100 * strength), 0.02f, {100 * strength, 100, 100 * strength}});
    }
    light.discs.push_back({at_elevation(-30), 0.02f, {1e5f, 1e5f, 1e5f}});
    const SkyLight sky = split_sky(light, {});
    ASSERT_EQ(sky.suns.size(), kMaxLayerSuns);
    EXPECT_EQ(sky.sun_discs, (std::vector<std::uint32_t>{1, 2}));
    const double weak = 100 * pi * std::pow(std::sin(0.02), 2) * 0.5;
    EXPECT_NEAR(sky.irradiance.r, pi + weak, 2e-3);
    // What remains is seen as well.
    EXPECT_NEAR(rest_radiance(sky, light, {}, at_elevation(30, 100)).r, 101, 1e-3);
    EXPECT_NEAR(rest_radiance(sky, light, {}, at_elevation(30, 300)).r, 1, 1e-6);
    EXPECT_NEAR(sun_part(sky, light, {}, at_elevation(30, 300)).r, 300, 1e-3);
}

TEST(SkyLight, FindsTheSunOfAMapFromSunsThatFillPixelsToSunsWithinOne) {
    for (const std::uint32_t width : {256u, 512u}) {
        for (const double radius : {0.0047, 0.02}) {
            const Vec3 place = at_elevation(41.3, 77.7);
            const double area = pi * radius * radius, pixel = std::pow(2 * pi / width, 2);
            const auto strength =
                static_cast<float>(3 / std::max(area, pixel));  // irradiance about 3
            const Environment map =
                area > 2 * pixel
                    ? sky_with_sun(width, place, radius, strength)
                    : lat_long_map(width, width / 2, [&](Vec3 d) {
                          const bool is_sun = length(d - place) < 0.5 * 2 * pi / width;
                          return is_sun ? Rgb{strength, strength, strength} : Rgb{1, 1, 1};
                      });
            const SkyLight sky = split_sky(map, {});
            ASSERT_EQ(sky.suns.size(), 1u) << width << ' ' << radius;
            EXPECT_LT(length(sky.suns[0].direction - place), 0.8 * 2 * pi / width);
            EXPECT_NEAR(sky.suns[0].angular_radius, std::max(radius, std::sqrt(pixel / pi)),
                        0.3 * radius + 2.0 / width);
            const Rgb seen =
                horizontal_irradiance([&](Vec3 d) { return formats::sample_radiance(map, d); });
            expect_same(whole_irradiance(sky), seen, 0.01);  // a dense sum over small suns
        }
    }
}

TEST(SkyLight, SunAndSkyConserveIrradianceUnderRotation) {
    const Environment map = sky_with_sun(512, at_elevation(60), 0.03, 400);
    const SkyLight still = split_sky(map, {});
    for (const double angle : {0.0, 0.7}) {
        const Rotation rotation = tilt(angle);
        const SkyLight sky = split_sky(map, rotation);
        ASSERT_EQ(sky.suns.size(), 1u);
        EXPECT_EQ(sky.suns[0].irradiance, still.suns[0].irradiance);
        EXPECT_EQ(sky.sun_luminance, still.sun_luminance);
        const auto whole = [&](Vec3 d) {
            return formats::sample_radiance(map, rotation.light_from_world(d));
        };
        const auto rest = [&](Vec3 d) { return rest_radiance(sky, map, rotation, d); };
        expect_same(whole_irradiance(sky), horizontal_irradiance(whole), 2e-3);
        expect_same(sky.irradiance, horizontal_irradiance(rest), 5e-3);
    }
}

TEST(SkyLight, SunAndRestAreTheWholeRadiance) {
    Environment map = sky_with_sun(256, at_elevation(20), 0.03, 400);
    const SkyLight sky = split_sky(map, tilt(0.3));
    ASSERT_EQ(sky.suns.size(), 1u);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 d = at_elevation(std::asin(i / 1000.0 - 0.9995) / kDegree, 137.5 * i);
        const Rgb rest = rest_radiance(sky, map, tilt(0.3), d);
        const Rgb sun = sun_part(sky, map, tilt(0.3), d);
        const Rgb whole = formats::sample_radiance(map, tilt(0.3).light_from_world(d));
        EXPECT_GE(std::min({rest.r, rest.g, rest.b, sun.r, sun.g, sun.b}), 0);
        expect_same(rest + sun, whole, 1e-6);
    }
    const Vec3 center = sky.suns[0].direction;
    EXPECT_GT(sun_part(sky, map, tilt(0.3), center).g, 300);
    EXPECT_LE(formats::luminance(rest_radiance(sky, map, tilt(0.3), center)),
              1.0001f * sky.sun_luminance);
}

TEST(SkyLight, MapsWithoutASunHaveNone) {
    const auto count = [](const Environment& map) { return split_sky(map, {}).suns.size(); };
    EXPECT_EQ(count({}), 0u);
    EXPECT_EQ(count(lat_long_map(64, 32, [](Vec3) { return Rgb{}; })), 0u);
    EXPECT_EQ(count(lat_long_map(2, 1, [](Vec3) { return Rgb{1, 1, 1}; })), 0u);
    EXPECT_EQ(count(lat_long_map(512, 256, tests::smooth_sky)), 0u);  // a lobe of 12 degrees
    // The aureole of a hidden sun, as Preetham's sky has it.
    EXPECT_EQ(count(sky_with_sun(512, at_elevation(30), 0.02, 0)), 0u);
}

TEST(SkyLight, CoarseHugeAndTinyMapsAreSplitWithoutHarm) {
    for (const float scale : {1e-30f, 1.0f, 1e30f}) {
        for (const std::uint32_t width : {2u, 8u, 64u, 256u}) {
            Environment map = lat_long_map(width, width / 2, [&](Vec3) {
                return Rgb{0.5f * scale * 1e-4f, scale * 1e-4f, scale * 1e-4f};
            });
            map.pixel[width / 8 * width + width / 3] = {scale, scale, scale};
            const SkyLight sky = split_sky(map, tilt(0.2));
            const Rgb whole = whole_irradiance(sky);
            EXPECT_TRUE(std::isfinite(whole.r + sky.horizon.r + whole.g)) << width;
            EXPECT_GT(whole.g, 0);
            EXPECT_EQ(sky.suns.size(), width < 64 ? 0u : 1u);  // a pixel of 45 degrees is none
        }
    }
}

TEST(SkyLight, DamagedPixelHidesNoSun) {
    Environment map = sky_with_sun(1024, at_elevation(50), 0.012, 3000);
    const SkyLight clean = split_sky(map, {});
    map.pixel[std::size_t{1024} * 300 + 17] = {9e3f, 9e3f, 9e3f};  // irradiance 0.3, the sun 1.2
    const SkyLight sky = split_sky(map, {});
    ASSERT_EQ(sky.suns.size(), 1u);
    EXPECT_LT(length(sky.suns[0].direction - clean.suns[0].direction), 1e-5f);
    // And alone it is none.
    Environment dull = sky_with_sun(1024, at_elevation(50), 0.012, 0);
    dull.pixel[std::size_t{1024} * 100 + 17] = {500, 500, 500};
    EXPECT_TRUE(split_sky(dull, {}).suns.empty());
}

// Cube maps and maps whose rows include the poles give the same suns.
TEST(SkyLight, LayoutOfTheMapDoesNotMatter) {
    const Vec3 place = at_elevation(33, 200);
    const auto radiance = [&](Vec3 d) {
        const float sun = length(d - place) < 0.04f ? 300.0f : 0.0f;
        return Rgb{1 + sun, 2 + d.y + sun, 3 + sun};
    };
    const SkyLight lat_long = split_sky(lat_long_map(512, 256, radiance), {});
    const SkyLight cube = split_sky(tests::cube_map(128, radiance), {});
    ASSERT_EQ(lat_long.suns.size(), 1u);
    ASSERT_EQ(cube.suns.size(), 1u);
    EXPECT_LT(length(lat_long.suns[0].direction - cube.suns[0].direction), 3e-3f);
    expect_same(cube.suns[0].irradiance, lat_long.suns[0].irradiance, 0.05);
    expect_same(cube.irradiance, lat_long.irradiance, 0.01);
    expect_same(cube.horizon, lat_long.horizon, 0.01);
}

// Radiance 1 + y has the mean 1 + sin(6 degrees) / 2 below 6 degrees, and the irradiance pi + 2/3
// pi.
TEST(SkyLight, IrradianceAndHorizonOfAGradientAreTheClosedForms) {
    const SkyLight sky = split_sky(lat_long_map(256, 128,
                                                [](Vec3 d) {
                                                    return Rgb{1, 1 + d.y, 2};
                                                }),
                                   {});
    EXPECT_NEAR(sky.horizon.g, 1 + 0.5 * std::sin(6 * kDegree), 1e-4);
    EXPECT_NEAR(sky.horizon.b, 2, 1e-5);
    EXPECT_NEAR(sky.irradiance.r, pi, 1e-3);
    EXPECT_NEAR(sky.irradiance.g, pi + 2 * pi / 3, 1e-3);
}

}  // namespace
}  // namespace opaline::runtime
