#include "formats/opal/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"

namespace opaline::formats {
namespace {

// A map whose pixels hold the direction they stand for, as colours.
Environment direction_map(Environment::Layout layout, std::uint32_t size) {
    Environment env;
    env.layout = layout;
    const bool cube = layout == Environment::Layout::cube;
    env.width = cube ? size : 2 * size;
    env.height = cube ? 6 * size : size;
    for (std::uint32_t row = 0; row < env.height; ++row) {
        for (std::uint32_t column = 0; column < env.width; ++column) {
            Vec3 d;
            if (cube) {
                d = texel_direction(size, row / size, row % size, column);
            } else {
                const double phi = ((column + 0.5) / env.width - 0.5) * 2 * std::numbers::pi;
                const double theta = (row + 0.5) / env.height * std::numbers::pi;
                d = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                     static_cast<float>(std::cos(theta)),
                     static_cast<float>(std::sin(theta) * std::sin(phi))};
            }
            env.pixel.push_back({d.x + 1, d.y + 1, d.z + 1});
        }
    }
    return env;
}

TEST(Environment, EveryDirectionFindsItsOwnPixel) {
    for (const auto layout : {Environment::Layout::lat_long, Environment::Layout::cube}) {
        const Environment env = direction_map(layout, 64);
        for (int i = 0; i < 500; ++i) {
            const double z = 1 - 2 * (i + 0.5) / 500, phi = 2.399963 * i;
            const double s = std::sqrt(1 - z * z);
            const Vec3 d{static_cast<float>(s * std::cos(phi)), static_cast<float>(z),
                         static_cast<float>(s * std::sin(phi))};
            const Rgb c = sample_map(env, d);
            // Half a pixel of 64 rows is 0.025 rad; bilinear interpolation stays well below.
            EXPECT_NEAR(c.r - 1, d.x, 0.03f);
            EXPECT_NEAR(c.g - 1, d.y, 0.03f);
            EXPECT_NEAR(c.b - 1, d.z, 0.03f);
        }
    }
}

TEST(Environment, CubeMapsAreContinuousAcrossEdges) {
    const Environment env = direction_map(Environment::Layout::cube, 16);
    for (float t = -0.9f; t < 0.95f; t += 0.1f) {
        const Rgb inside = sample_map(env, normalize({1.0f, t, 0.9999f}));
        const Rgb outside = sample_map(env, normalize({0.9999f, t, 1.0f}));
        EXPECT_NEAR(inside.r, outside.r, 0.01f);
        EXPECT_NEAR(inside.b, outside.b, 0.01f);
    }
}

TEST(Environment, ADiscShinesWithinItsRadiusOnly) {
    Environment env;
    env.discs.push_back({{0, 0, 1}, 0.01f, {2, 3, 4}});
    EXPECT_EQ(sample_radiance(env, {0, 0, 1}), (Rgb{2, 3, 4}));
    EXPECT_EQ(sample_radiance(env, {std::sin(0.0099f), 0, std::cos(0.0099f)}), (Rgb{2, 3, 4}));
    EXPECT_EQ(sample_radiance(env, {std::sin(0.0101f), 0, std::cos(0.0101f)}), (Rgb{}));
    EXPECT_EQ(sample_map(env, {0, 0, 1}), (Rgb{}));
}

TEST(Environment, SmallDiscsKeepTheirSolidAngle) {
    const float r = 1e-4f;
    EXPECT_NEAR(disc_solid_angle(r) / (std::numbers::pi * r * r), 1.0, 1e-7);
    EXPECT_NEAR(disc_solid_angle(std::numbers::pi_v<float>), 4 * std::numbers::pi, 1e-5);
}

}  // namespace
}  // namespace opaline::formats
