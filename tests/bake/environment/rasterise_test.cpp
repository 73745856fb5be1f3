
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"

namespace opaline::bake {
namespace {

using formats::Environment;

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
