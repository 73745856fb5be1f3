#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"
#include "runtime/clouds/environment_at.h"
#include "runtime/clouds/sky_light.h"
#include "runtime/texture.h"
#include "tests/runtime/clouds/lit_layer.h"

// The lights that a command line names, as cloud layers take them.

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;

constexpr std::uint8_t kAlbedoCode = 180;

// A sky of radiance 0.3 and a sun of irradiance 1 facing it.
Environment sun_and_sky(double sine, double azimuth = 0) {
    return test::sunny_day(0.3f, sine, azimuth, 0.002f);
}

// Flux needs the mean over azimuths alone.
formats::Clouds even_clouds(double peak_angle, double thickness = 1e9) {
    test::TestLayer layer = test::even_test_layer();
    layer.droplets.peak_angle = peak_angle;
    layer.radiance = {24, 20, 1};
    if (thickness == 0) layer.radiance = {0, 0, 0};
    return test::make_test_clouds(layer, [&](std::uint32_t, std::uint32_t) { return thickness; },
                                  {kAlbedoCode, kAlbedoCode, kAlbedoCode, 255});
}

// Half of it without clouds, and a ground of stripes.
formats::Clouds patchy_clouds() {
    test::TestLayer layer = test::even_test_layer();
    layer.record.columns = layer.record.rows = 16;
    layer.record.highest = 300;
    layer.radiance = {6, 6, 4};
    return test::make_test_clouds(layer, [](std::uint32_t column, std::uint32_t row) {
        return (column / 4 + row / 4) % 2 == 0 ? 0.0 : 20.0 * (column % 4 + 3.0 * (row % 4));
    });
}

// Irradiance on a plane with this normal, of the green band.
double irradiance(const Environment& environment, Vec3 normal) {
    double sum = 0;
    for (std::uint32_t row = 0; row < environment.height; ++row) {
        const double top = std::cos(pi * row / environment.height);
        const double bottom = std::cos(pi * (row + 1) / environment.height);
        for (std::uint32_t column = 0; column < environment.width; ++column) {
            const double azimuth = 2 * pi * ((column + 0.5) / environment.width - 0.5);
            const Vec3 d = test::direction_of((top + bottom) / 2, azimuth);
            sum += (top - bottom) * 2 * pi / environment.width *
                   std::max(0.0, double{dot(normal, d)}) *
                   double{environment.pixel[std::size_t{row} * environment.width + column].g};
        }
    }
    for (const formats::DistantDisc& disc : environment.discs) {
        sum += pi * std::pow(std::sin(double{disc.angular_radius}), 2) * double{disc.radiance.g} *
               std::max(0.0, double{dot(normal, disc.direction)});
    }
    return sum;
}

Environment discs_alone(const Environment& environment) {
    Environment alone;
    alone.discs = environment.discs;
    return alone;
}

// The same by rays, 400 x 200 of them; the suns' discs, which rays would miss, from the result.
Environment trace_rays(const LayerScene& scene, Vec3 point, const Environment& local) {
    Environment dense;
    dense.width = 400;
    dense.height = 200;
    for (std::uint32_t row = 0; row < dense.height; ++row) {
        const double y =
            (std::cos(pi * row / dense.height) + std::cos(pi * (row + 1) / dense.height)) / 2;
        for (std::uint32_t column = 0; column < dense.width; ++column) {
            LayerRay ray;
            ray.origin = point;
            ray.direction = test::direction_of(y, 2 * pi * ((column + 0.5) / dense.width - 0.5));
            const Rgb sun =
                sun_part(scene.light.sky, scene.environment, scene.rotation, ray.direction);
            dense.pixel.push_back(sun.g > 0 ? Rgb{} : see_through_layer(scene, ray));
        }
    }
    dense.discs = local.discs;
    return dense;
}

// Beneath an even layer the ground has E = S / (1 - rho Rbar), S what crosses the layer: of the
// sun mu_l T_ms, of the sky Tbar. So has the body's upper side; its lower side rho E.
TEST(EnvironmentAt, BeneathAnEvenLayerHasTheFluxOfTheSlab) {
    const double albedo = double{linear_from_srgb(kAlbedoCode)};
    for (const double peak_angle : {0.08, 0.0}) {
        const formats::Clouds clouds = even_clouds(peak_angle);
        for (const double sine : {0.9, 0.5}) {
            const test::LitLayer lit(clouds, sun_and_sky(sine));
            const std::array<float, 3> depth = rest_depths(lit.light, lit.light.record.highest);
            const FluxShares flux = flux_shares(lit.light.tables[1], lit.light.record, depth[1],
                                                static_cast<float>(sine));
            const double mean = double{mean_transmittance(lit.light.tables[1], depth[1])};
            const double down = sine * double{flux.straight + flux.across} + 0.3 * pi * mean;
            const double expected = down / (1 - albedo * (1 - mean));
            const Environment local = environment_at(lit.scene(), {10, 50, 20});
            EXPECT_NEAR(irradiance(local, {0, 1, 0}) / expected, 1, 0.01) << peak_angle << sine;
            EXPECT_NEAR(irradiance(local, {0, -1, 0}) / expected / albedo, 1, 0.01);
            ASSERT_EQ(local.discs.size(), 1u);
            EXPECT_EQ(local.discs[0].angular_radius, 0.002f);
            const double whole =
                double{depth[1]} / (1 - double{lit.light.record.band[1].peak_weight});
            EXPECT_NEAR(
                irradiance(discs_alone(local), local.discs[0].direction) / std::exp(-whole / sine),
                1, 1e-3);
        }
    }
}

// Without a cloud: the sky as it is, a ground of radiance albedo / pi E, the sun undimmed.
TEST(EnvironmentAt, OverUniformGroundWithoutCloudsIsSkyAndGround) {
    const test::LitLayer lit(even_clouds(0.08, 0), sun_and_sky(0.6));
    const Environment local = environment_at(lit.scene(), {0, 50, 0}, {64, 32, 1});
    const double ground = double{linear_from_srgb(kAlbedoCode)} / pi * (0.6 + 0.3 * pi);
    for (std::size_t i = 0; i < local.pixel.size(); ++i) {
        EXPECT_NEAR(local.pixel[i].g, i < local.pixel.size() / 2 ? 0.3 : ground, 2e-3);
    }
    ASSERT_EQ(local.discs.size(), 1u);
    EXPECT_NEAR(irradiance(local, {0, 1, 0}), 0.6 + 0.3 * pi, 2e-3);
}

TEST(EnvironmentAt, HasTheIrradianceOfRaysOnAnyPlane) {
    const test::LitLayer lit(patchy_clouds(), sun_and_sky(0.7, 1));
    for (const Vec3 point : {Vec3{300, 20, -700}, Vec3{-900, 2500, 100}}) {
        const Environment local = environment_at(lit.scene(), point);
        const Environment dense = trace_rays(lit.scene(), point, local);
        for (const Vec3 normal : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0},
                                  formats::normalize({-0.3f, 0.5f, 0.8f})}) {
            const double expected = irradiance(dense, normal);
            EXPECT_NEAR(irradiance(local, normal) / expected, 1, 0.01)
                << point.y << ' ' << normal.y;
        }
    }
}

TEST(EnvironmentAt, SunOfAMapBecomesADiscAndOtherDiscsStay) {
    // A map of 1 degree a pixel with a sun of 2 degrees' radius; and three discs.
    const Vec3 place = test::direction_of(0.8, 0.5);
    Environment map = test::white_sky(0.3f);
    map.width = 360;
    map.height = 180;
    map.pixel.clear();
    for (std::uint32_t i = 0; i < 360 * 180; ++i) {
        const double polar = pi * (i / 360 + 0.5) / 180;
        const Vec3 d = test::direction_of(std::cos(polar), 2 * pi * ((i % 360 + 0.5) / 360 - 0.5));
        const float sun = length(d - place) < 0.035f ? 200.0f : 0.0f;
        map.pixel.push_back({0.3f + sun, 0.3f + sun, 0.3f + sun});
    }
    const test::LitLayer of_map(even_clouds(0.08, 0), map);
    const Environment local = environment_at(of_map.scene(), {0, 50, 0}, {64, 32, 1});
    ASSERT_EQ(local.discs.size(), 1u);
    EXPECT_LT(length(local.discs[0].direction - place), 0.01f);
    EXPECT_NEAR(local.discs[0].radiance.g, 200, 20);
    for (const Rgb& pixel : local.pixel)
        EXPECT_LT(pixel.g, 1.5f);

    Environment discs = sun_and_sky(0.5);
    for (int i = 0; i < 2; ++i)
        discs.discs.push_back(discs.discs[0]);
    discs.discs.push_back(discs.discs[0]);
    discs.discs[3].direction = {0, -1, 0};
    const test::LitLayer of_discs(even_clouds(0.08, 0), discs);
    const Environment three = environment_at(of_discs.scene(), {0, 50, 0}, {64, 32, 1});
    EXPECT_EQ(three.discs.size(), 3u);
    EXPECT_NEAR(irradiance(discs_alone(three), {0, 1, 0}), 3 * 0.5, 1e-3);
}

TEST(EnvironmentAt, HasTheSameBitsForAnyNumberOfThreadsAndNoBadValueAnywhere) {
    const test::LitLayer lit(patchy_clouds(), sun_and_sky(0.3));
    for (const Vec3 point : {Vec3{0, -500, 0}, Vec3{0, 0, 0}, Vec3{0, 1000, 0}, Vec3{0, 1100, 0},
                             Vec3{1e7f, 3, -1e7f}, Vec3{0, 1e6f, 0}}) {
        const Environment one = environment_at(lit.scene(), point, {32, 16, 1});
        const Environment many = environment_at(lit.scene(), point, {32, 16, 5});
        EXPECT_EQ(one.pixel, many.pixel);
        for (const Rgb& pixel : one.pixel)
            EXPECT_TRUE(test::is_lit(pixel)) << point.y;
        for (const formats::DistantDisc& disc : one.discs)
            EXPECT_TRUE(test::is_lit(disc.radiance));
    }
}

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
