#include "runtime/light_vector.h"

#include <gmock/gmock.h>

#include "tests/runtime/light_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;
using tests::cube_map;
using tests::flux;
using tests::lat_long_map;
using tests::relative_difference;
using tests::smooth_sky;
using tests::texels_of;

Rgb white(Vec3) {
    return {1, 1, 1};
}

TEST(LightVector, ConstantMapGivesTheSolidAnglesOfTheTexels) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(32);
    for (const Environment& map :
         {lat_long_map(1024, 512, white), lat_long_map(64, 32, white), lat_long_map(7, 3, white),
          lat_long_map(2500, 1300, white), cube_map(256, white), cube_map(5, white),
          cube_map(700, white)}) {
        const LightVector light = project_environment(map, 32);
        const std::vector<double> texel = texels_of(light, 1);
        for (std::size_t j = 0; j < texel.size(); ++j) {
            // Coefficients are floats and the face average is 32 times a texel: its rounding shows.
            ASSERT_NEAR(texel[j] / solid_angle[j % 1024], 1.0, 2e-6) << map.width << " texel " << j;
        }
        EXPECT_NEAR(flux(light, 0), 4 * pi, 1e-5);
    }
}

TEST(LightVector, LatLongMapAndTheSameMapAsACubeAgree) {
    for (const std::uint32_t n : {8u, 32u, 64u}) {
        const LightVector a = project_environment(lat_long_map(1024, 512, smooth_sky), n);
        const LightVector b = project_environment(cube_map(256, smooth_sky), n);
        EXPECT_LT(relative_difference(a, b), 1e-3) << n;
    }
}

TEST(LightVector, CoarseMapIsInterpolatedAsTheSampleFunctionSays) {
    const Environment coarse = lat_long_map(64, 32, smooth_sky);
    const std::uint32_t n = 32, fine = 1024;
    const Environment dense = cube_map(fine, [&](Vec3 d) { return sample_map(coarse, d); });
    EXPECT_LT(relative_difference(project_environment(coarse, n), project_environment(dense, n)),
              1e-4);
}

TEST(LightVector, CubeMapOfTheBasisSizeIsTakenTexelByTexel) {
    const Environment map = cube_map(16, smooth_sky);
    const LightVector light = project_environment(map, 16);
    EXPECT_EQ(light.rgba, project_cubemap(map.pixel, 16).rgba);
    const std::vector<double> texel = texels_of(light, 0);
    const std::vector<double> solid_angle = formats::texel_solid_angles(16);
    for (std::size_t j = 0; j < texel.size(); ++j) {
        const double expected = map.pixel[j].r * solid_angle[j % 256];
        ASSERT_NEAR(texel[j], expected, 1e-5 * 200 * solid_angle[j % 256]);
    }
}

// A lone bright pixel is where point sampling goes wrong; its flux is radiance times the exact
// solid angle of its cell.
TEST(LightVector, LoneBrightPixelKeepsItsFlux) {
    for (const std::uint32_t row : {0u, 1u, 100u, 255u, 511u}) {
        for (const std::uint32_t column : {0u, 383u}) {
            Environment map = lat_long_map(1024, 512, [](Vec3) { return Rgb{}; });
            map.pixel[row * 1024 + column] = {1e4f, 2e4f, 0};
            const double band = std::cos(pi * row / 512) - std::cos(pi * (row + 1) / 512);
            const double expected = 1e4 * 2 * pi / 1024 * band;
            const LightVector light = project_environment(map, 32);
            // Its eight-times-the-mean part is sampled on the grid: less than 1e-4 of it.
            EXPECT_NEAR(flux(light, 0) / expected, 1.0, 1e-5) << row << " " << column;
            EXPECT_NEAR(flux(light, 1) / expected, 2.0, 2e-5);
            EXPECT_EQ(flux(light, 2), 0.0);
        }
    }
}

TEST(LightVector, LoneBrightPixelOfAReducedMapKeepsItsFlux) {
    Environment map = lat_long_map(4096, 2048, [](Vec3) { return Rgb{}; });
    map.pixel[700 * 4096 + 1234] = {1e6f, 0, 0};
    const double band = std::cos(pi * 700 / 2048) - std::cos(pi * 701 / 2048);
    EXPECT_NEAR(flux(project_environment(map, 16), 0) / (1e6 * 2 * pi / 4096 * band), 1.0, 1e-5);

    Environment cube = cube_map(1000, [](Vec3) { return Rgb{}; });
    cube.pixel[300 * 1000 + 17] = {1e6f, 0, 0};
    const double step = 2.0 / 1000, u = 17 * step - 1, v = 300 * step - 1;
    const double expected = 1e6 * formats::rectangle_solid_angle(u, v, u + step, v + step);
    EXPECT_NEAR(flux(project_environment(cube, 16), 0) / expected, 1.0, 1e-5);
}

TEST(LightVector, LatLongOrientationsAreHonoured) {
    // The same sky stored the OpenEXR way: u = 1/2 - atan2(x, z) / 2 pi, which is 1/4 + our turn.
    Environment exr;
    exr.width = 512;
    exr.height = 257;
    exr.u_offset = 0.25f;
    exr.rows_include_poles = true;
    for (std::uint32_t row = 0; row < exr.height; ++row) {
        for (std::uint32_t column = 0; column < exr.width; ++column) {
            const double phi = 2 * pi * ((column + 0.5) / exr.width - 0.25);
            const double theta = pi * row / (exr.height - 1);
            exr.pixel.push_back(smooth_sky({static_cast<float>(std::sin(theta) * std::cos(phi)),
                                            static_cast<float>(std::cos(theta)),
                                            static_cast<float>(std::sin(theta) * std::sin(phi))}));
        }
    }
    const LightVector expected = project_environment(lat_long_map(1024, 512, smooth_sky), 16);
    EXPECT_LT(relative_difference(project_environment(exr, 16), expected), 1e-3);
}

TEST(LightVector, QuarterTurnPermutesTheTexels) {
    const Rotation turn{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    for (const Environment& map :
         {lat_long_map(1024, 512, smooth_sky), lat_long_map(64, 32, smooth_sky),
          cube_map(64, smooth_sky), cube_map(48, smooth_sky)}) {
        const std::uint32_t n = 16;
        const std::vector<double> still = texels_of(project_environment(map, n), 0);
        const std::vector<double> turned = texels_of(project_environment(map, n, turn), 0);
        for (std::uint32_t j = 0; j < still.size(); ++j) {
            const Vec3 d = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
            const double expected = still[formats::texel_index(n, turn.light_from_world(d))];
            // Directions are floats; next to the lobe radiance changes by 1e3 a radian.
            ASSERT_NEAR(turned[j], expected, 2e-5 * std::abs(expected) + 1e-6) << map.width;
        }
    }
}

TEST(LightVector, AnyRotationKeepsTheFlux) {
    const Rotation turn = rotation_about_y(0.7f);
    const Vec3 x = formats::normalize({0.6f, 0.5f, -0.4f}), z = normalize(cross(x, Vec3{0, 1, 0}));
    for (const Rotation& r : {turn, Rotation{x, cross(z, x), z}}) {
        ASSERT_TRUE(is_rotation(r));
        for (const Environment& map :
             {lat_long_map(1024, 512, smooth_sky), cube_map(64, smooth_sky)}) {
            const double expected = flux(project_environment(map, 32), 0);
            EXPECT_NEAR(flux(project_environment(map, 32, r), 0) / expected, 1.0, 1e-4);
        }
    }
}

TEST(LightVector, DiscsOfAnySizeHaveTheirFluxInTheRightPlace) {
    for (const float radius : {1e-5f, 0.0046f, 0.05f, 0.2f, 0.9f, 1.5f}) {
        Environment sky;
        const Vec3 toward = formats::normalize({-0.4f, 0.3f, 0.8f});
        sky.discs.push_back({toward, radius, {2, 1, 0}});
        const LightVector light = project_environment(sky, 32);
        EXPECT_NEAR(flux(light, 0) / (2 * formats::disc_solid_angle(radius)), 1.0, 1e-6) << radius;
        // Mean direction: a disc's first moment is pi sin^2 r toward its centre.
        const std::vector<double> texel = texels_of(light, 1);
        const std::vector<Vec3> moment = formats::texel_moments(32);
        const std::vector<double> solid_angle = formats::texel_solid_angles(32);
        double along = 0;
        for (std::size_t j = 0; j < texel.size(); ++j) {
            along += texel[j] / solid_angle[j % 1024] * dot(moment[j], toward);
        }
        // Texels are 1/16 wide: what the disc shares with one is spread over it.
        EXPECT_NEAR(along / (pi * std::pow(std::sin(radius), 2)), 1.0, 2e-3) << radius;
    }
}

// What a cosine sees of it: half a texel, .06 rad, is what the nearest texel alone would miss.
TEST(LightVector, SmallSunsShineFromWhereTheyAreToSecondOrder) {
    constexpr std::uint32_t kFaceSize = 16;
    for (int i = 0; i < 50; ++i) {
        const float z = 1 - (static_cast<float>(i) + 0.5f) / 25, phi = 2.4f * static_cast<float>(i);
        const float r = std::sqrt(1 - z * z);
        const Vec3 toward{r * std::cos(phi), r * std::sin(phi), z};
        Environment sky;
        sky.discs.push_back({toward, 0.0046f, {1, 1, 1}});
        const std::vector<double> texel = texels_of(project_environment(sky, kFaceSize), 0);
        Vec3 mean{0, 0, 0};
        for (std::uint32_t j = 0; j < texel.size(); ++j) {
            mean = mean + static_cast<float>(texel[j]) *
                              formats::texel_direction(kFaceSize, j / (kFaceSize * kFaceSize),
                                                       j / kFaceSize % kFaceSize, j % kFaceSize);
        }
        EXPECT_LT(length(cross(formats::normalize(mean), toward)), 0.012f) << i;
    }
}

TEST(LightVector, ThreadsDoNotChangeABit) {
    Environment map = lat_long_map(512, 256, smooth_sky);
    map.pixel[9000] = {1e5f, 1e5f, 1e5f};
    map.discs.push_back({{0, 1, 0}, 0.005f, {1e4f, 1e4f, 1e4f}});
    const LightVector one = project_environment(map, 16, rotation_about_y(0.3f), 1);
    for (const unsigned threads : {2u, 3u, 7u, 0u}) {
        EXPECT_EQ(project_environment(map, 16, rotation_about_y(0.3f), threads).rgba, one.rgba);
    }
}

TEST(LightVector, RefusesWhatIsNoRotation) {
    EXPECT_TRUE(is_rotation(Rotation{}));
    EXPECT_FALSE(is_rotation({{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}));  // a mirror
    EXPECT_FALSE(is_rotation({{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_FALSE(is_rotation({{NAN, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace opaline::runtime
