#include "bake/lab/path_images/image_lights.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bake/lights/builtin_environment.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

glm::dvec3 sum_of(const ImageLights& lights) {
    glm::dvec3 sum(0);
    for (const ImageSun& sun : lights.suns) {
        sum += sun.irradiance;
    }
    for (const SkyTexel& texel : lights.sky.texel) {
        sum += texel.irradiance;
    }
    return sum;
}

TEST(ImageLights, OfAnEvenSkyHoldRadianceTimesTheSphere) {
    const ImageLights lights = make_image_lights(tests::make_white_sky(), glm::mat3(1));
    EXPECT_TRUE(lights.suns.empty());
    EXPECT_NEAR(sum_of(lights).x, 4 * pi, 1e-5);
    for (const SkyTexel& texel : lights.sky.texel) {
        const glm::dvec3 cell = sky_cells()[texel.cell];
        EXPECT_GT(glm::dot(cell, texel.direction), 0.94);
        EXPECT_NEAR(texel.irradiance.x / texel.solid_angle, 1, 1e-5);
    }
}

TEST(ImageLights, SunIsOneDirectionWithItsIrradianceTurnedWithTheLight) {
    const auto sun = make_environment("sun:90,0");
    ASSERT_TRUE(sun);
    // A quarter turn about +Y takes +X to -Z.
    const glm::mat3 turn(glm::vec3(0, 0, -1), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0));
    const ImageLights lights = make_image_lights(*sun, turn);
    ASSERT_EQ(lights.suns.size(), 1u);
    EXPECT_TRUE(lights.sky.texel.empty());
    EXPECT_NEAR(glm::length(lights.suns[0].direction - glm::dvec3(0, 0, -1)), 0, 1e-6);
    EXPECT_NEAR(lights.suns[0].irradiance.x, pi, 1e-4);
}

TEST(ImageLights, SmallBrightPartOfAMapBecomesASunWhereItIs) {
    formats::Environment map;
    map.width = 256;
    map.height = 128;
    map.pixel.assign(std::size_t{map.width} * map.height, {0.1f, 0.1f, 0.1f});
    const std::size_t bright = 40 * map.width + 70;
    map.pixel[bright] = map.pixel[bright + 1] = {5000, 4000, 3000};
    const ImageLights lights = make_image_lights(map, glm::mat3(1));
    ASSERT_FALSE(lights.suns.empty());
    ASSERT_LE(lights.suns.size(), 4u);
    const double azimuth = 2 * pi * (71.0 / map.width - 0.5), polar = pi * 40.5 / map.height;
    const glm::dvec3 at(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                        std::sin(polar) * std::sin(azimuth));
    for (const ImageSun& sun : lights.suns) {
        EXPECT_GT(glm::dot(sun.direction, at), std::cos(0.04));
    }
}

TEST(ImageLights, WideDiscIsPartOfTheSky) {
    formats::Environment disc;
    disc.discs.push_back({{0, 1, 0}, 0.5f, {2, 2, 2}});
    const ImageLights lights = make_image_lights(disc, glm::mat3(1));
    EXPECT_TRUE(lights.suns.empty());
    EXPECT_NEAR(sum_of(lights).x / (2 * formats::disc_solid_angle(0.5f)), 1, 0.01);
}

}  // namespace
}  // namespace opaline::bake
