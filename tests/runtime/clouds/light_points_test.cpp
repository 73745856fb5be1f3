
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/clouds/environment_at.h"
#include "runtime/clouds/part_environments.h"
#include "runtime/shade.h"
#include "tests/runtime/clouds/lit_layer.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kTexels = 8;

// A node of its own for each ball.
Asset balls_at(std::initializer_list<Vec3> centres) {
    Asset asset = test::make_asset(kTexels, 16);
    for (const Vec3 centre : centres) {
        test::add_primitive(asset, test::make_sphere(centre, 2, 8, 6), {});
        asset.primitives.back().node = static_cast<std::uint32_t>(asset.primitives.size());
    }
    return asset;
}

// 100 m thick for x < 0, nothing for x > 0; texels of 500 m.
formats::Clouds half_clouds() {
    static const formats::Clouds kMade = [] {
        test::TestLayer layer = test::even_test_layer();
        layer.record.columns = layer.record.rows = 16;
        layer.flux = {16, 10};
        layer.radiance = {6, 6, 2};
        return test::make_test_clouds(
            layer, [](std::uint32_t column, std::uint32_t) { return column < 8 ? 100.0 : 0.0; });
    }();
    return kMade;
}

constexpr Vec3 kUnderCloud{-2000, 5, 0}, kUnderHole{2000, 5, 0};

std::vector<Rgb> relight(const Asset& asset, const test::LitLayer& lit, const LightPoints& points) {
    std::vector<LightVector> light;
    for (const Vec3 point : points.point) {
        light.push_back(
            project_environment(environment_at(lit.scene(), point, {64, 32, 1}), kTexels));
    }
    std::vector<Rgb> radiance(asset.position.size());
    shade(asset.view(), {light, points.of_primitive, points.of_volumes}, radiance, {.threads = 1});
    return radiance;
}

float mean_green(std::span<const Rgb> radiance) {
    float sum = 0;
    for (const Rgb color : radiance) {
        sum += color.g / static_cast<float>(radiance.size());
    }
    return sum;
}

TEST(LightPoints, BallsUnderACloudAndAHoleAreLitAsInScenesOfTheirOwn) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    const Asset both = balls_at({kUnderCloud, kUnderHole});
    const LightPoints points = light_points(both.view(), {}, lit.light.field, {0, 5, 0});
    ASSERT_EQ(points.point.size(), 2u);
    const std::vector<Rgb> together = relight(both, lit, points);
    const std::size_t half = together.size() / 2;
    float mean[2] = {};
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec3 centre = k == 0 ? kUnderCloud : kUnderHole;
        const Asset one = balls_at({centre});
        const std::vector<Rgb> alone =
            relight(one, lit, light_points(one.view(), {}, lit.light.field, centre));
        const std::span<const Rgb> part = std::span(together).subspan(k * half, half);
        EXPECT_TRUE(std::ranges::equal(part, alone));
        mean[k] = mean_green(part);
    }
    EXPECT_GT(mean[1], 1.3f * mean[0]);
}

TEST(LightPoints, WhatStandsTogetherHasTheGivenPoint) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    const Vec3 centre{1, 2, 3};
    for (const Asset& asset : {balls_at({{0, 5, 0}}), balls_at({{0, 5, 0}, {400, 5, 300}})}) {
        const LightPoints points = light_points(asset.view(), {}, lit.light.field, centre);
        ASSERT_EQ(points.point.size(), 1u);
        EXPECT_EQ(points.point[0], centre);
        EXPECT_EQ(points.of_primitive, std::vector<std::uint32_t>(asset.primitives.size(), 0));
    }
    test::TestLayer even = test::even_test_layer();
    even.flux = {16, 10};
    even.radiance = {0, 0, 0};
    const test::LitLayer endless(test::make_test_clouds(even), test::sunny_day(0.2f, 0.95));
    const Asset far_apart = balls_at({kUnderCloud, kUnderHole});
    EXPECT_EQ(light_points(far_apart.view(), {}, endless.light.field, centre).point.size(), 1u);
}

TEST(LightPoints, ANodeIsNeverDivided) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    Asset asset = balls_at({kUnderCloud, kUnderHole, {4000, 5, 0}});
    asset.primitives[1].node = asset.primitives[0].node;
    const LightPoints points = light_points(asset.view(), {}, lit.light.field, {});
    ASSERT_EQ(points.point.size(), 2u);
    EXPECT_EQ(points.of_primitive, (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_EQ(points.point[0], (Vec3{0, 5, 0}));
}

TEST(LightPoints, VolumesFarFromBodiesHaveAPointOfTheirOwn) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    const Asset ball = balls_at({kUnderCloud});
    const std::vector<Vec3> corners{{1990, 0, -10}, {2010, 20, 10}};
    const LightPoints points = light_points(ball.view(), corners, lit.light.field, {});
    ASSERT_EQ(points.point.size(), 2u);
    EXPECT_EQ(points.of_primitive, std::vector<std::uint32_t>{0});
    EXPECT_EQ(points.of_volumes, 1u);
    EXPECT_EQ(points.point[1], (Vec3{2000, 10, 0}));
}

TEST(LightPoints, AreFewHoweverManyTheNodesAre) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    Asset asset = test::make_asset(kTexels, 16);
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(900 * (i % 10)), z = static_cast<float>(900 * (i / 10));
        test::add_primitive(asset, test::make_sheet({x, 0, z}, {1, 0, 0}, {0, 0, 1}, 1, 1), {});
        asset.primitives.back().node = static_cast<std::uint32_t>(i);
    }
    const LightPoints points = light_points(asset.view(), {}, lit.light.field, {});
    EXPECT_GT(points.point.size(), 4u);
    EXPECT_LE(points.point.size(), kMaxLightPoints);
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        const Vec3 point = points.point[points.of_primitive[p]];
        const Vec3 at = asset.position[asset.primitives[p].first_vertex];
        EXPECT_LT(length(point - at), 3000.0f);
    }
}

// What is mirrored is seen from the centre, which takes a map of its own: only where something is.
TEST(PartEnvironments, AreThoseAtThePointsAndAtTheCentreIfSomethingIsMirrored) {
    const test::LitLayer lit(half_clouds(), test::sunny_day(0.2f, 0.95));
    Asset asset = balls_at({kUnderCloud, kUnderHole});
    const Vec3 centre{0, 5, 0};
    PartEnvironments parts = environments_of_parts(lit.scene(), asset.view(), {}, centre, 1);
    EXPECT_EQ(parts.points.point, (std::vector<Vec3>{kUnderCloud, kUnderHole}));
    ASSERT_EQ(parts.at_point.size(), 2u);
    const auto map_at = [&](Vec3 point) {
        return environment_at(lit.scene(), point, {.threads = 1}).pixel;
    };
    EXPECT_EQ(parts.at_point[0].pixel, map_at(kUnderCloud));
    EXPECT_EQ(parts.at_point[1].pixel, map_at(kUnderHole));
    EXPECT_FALSE(parts.at_centre);
    asset.roughness = {0.3f, formats::kNotGlossy};
    parts = environments_of_parts(lit.scene(), asset.view(), {}, centre, 1);
    EXPECT_EQ(parts.mirrored().pixel, map_at(centre));
    const Asset one = balls_at({kUnderHole});
    parts = environments_of_parts(lit.scene(), one.view(), {}, kUnderHole, 1);
    EXPECT_EQ(parts.at_point.size(), 1u);
    EXPECT_EQ(&parts.mirrored(), &parts.at_point[0]);
}

}  // namespace
}  // namespace opaline::runtime
