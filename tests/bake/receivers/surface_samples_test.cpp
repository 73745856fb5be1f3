#include "bake/receivers/surface_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

TEST(SurfaceSamples, AreasAddUpToTheSurface) {
    const auto scene = tests::make_scene({tests::make_sphere(3), tests::make_cube(2, false)});
    const auto samples = sample_surface(scene, {0, 1}, 1000, 5, {});
    ASSERT_EQ(samples.size(), 1000u);
    double sum = 0;
    std::size_t on_sphere = 0;
    for (const SurfaceSample& s : samples) {
        sum += s.area;
        on_sphere += s.primitive == 0 ? 1 : 0;
    }
    const double sphere = formats::surface_area(scene.primitives[0]),
                 cube = formats::surface_area(scene.primitives[1]);
    EXPECT_NEAR(sum / (sphere + cube), 1, 1e-5);
    // Elimination keeps slightly more points where neighbours are fewer: along the edges of a cube.
    EXPECT_NEAR(on_sphere / 1000.0, sphere / (sphere + cube), 0.02);
}

// Blue noise: no two samples closer than half the closest packing's distance,
// sqrt(2 A / (sqrt(3) N)); independent points come arbitrarily close.
TEST(SurfaceSamples, SamplesKeepTheirDistance) {
    const auto scene = tests::make_scene({tests::make_sphere(4)});
    const auto samples = sample_surface(scene, {0}, 800, 1, {});
    const double packed =
        std::sqrt(2 * formats::surface_area(scene.primitives[0]) / (std::sqrt(3.0) * 800));
    double closest = 10;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            closest =
                std::min<double>(closest, glm::distance(samples[i].position, samples[j].position));
        }
    }
    EXPECT_GT(closest / packed, 0.5);
}

TEST(SurfaceSamples, BothSidesOfAThinSheetAreCoveredEqually) {
    const auto scene =
        tests::make_scene({tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 4),
                           tests::make_quad({0, -1e-4f, 0}, {1, 0, 0}, {0, 0, 1}, 4)});
    std::size_t up = 0;
    double area_up = 0;
    for (const SurfaceSample& s : sample_surface(scene, {0, 1}, 600, 3, {})) {
        up += s.geometric_normal.y > 0 ? 1 : 0;
        area_up += s.geometric_normal.y > 0 ? s.area : 0;
    }
    EXPECT_NEAR(up, 300, 6);
    EXPECT_NEAR(area_up / formats::surface_area(scene.primitives[0]), 1, 1e-5)
        << "cells end at their own side";
}

// The dipole requires that sums of a bell 1.2 spacings wide do not depend on the bell's position.
// With equal weights at the same positions the sums vary by 5 %.
TEST(SurfaceSamples, SumsOfABellAsWideAsTheSpacingAreEven) {
    const auto scene = tests::make_scene({tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 8)});
    const auto samples = sample_surface(scene, {0}, 2500, 1, {});
    const double z = 1.2 / 50;
    double sum = 0, squares = 0;
    constexpr int kPlaces = 20;
    for (int i = 0; i < kPlaces; ++i) {
        for (int j = 0; j < kPlaces; ++j) {
            const double x = 0.3 + 0.4 * i / kPlaces, y = 0.3 + 0.4 * j / kPlaces;
            double value = 0;
            for (const SurfaceSample& s : samples) {
                const double dx = s.position.x - x, dy = s.position.z - y;
                value += s.area * z / (2 * 3.14159265 * std::pow(dx * dx + dy * dy + z * z, 1.5));
            }
            sum += value;
            squares += value * value;
        }
    }
    const double mean = sum / (kPlaces * kPlaces);
    EXPECT_LT(std::sqrt(squares / (kPlaces * kPlaces) - mean * mean) / mean, 0.012);
}

TEST(SurfaceSamples, SurfacesWithoutAreaHaveNone) {
    auto scene = tests::make_scene({tests::make_sphere(0)});
    scene.primitives[0].position.assign(scene.primitives[0].position.size(), {1, 2, 3});
    EXPECT_TRUE(sample_surface(scene, {0}, 100, 1, {}).empty());
    EXPECT_TRUE(sample_surface(scene, {}, 100, 1, {}).empty());
}

}  // namespace
}  // namespace opaline::bake
