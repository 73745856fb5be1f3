// Light straight from lamps, against closed forms.
#include "bake/exchange/lamps/straight_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

using formats::Light;

glm::dvec3 receive(const formats::Scene& scene, const Receiver& receiver,
                   std::uint32_t samples = 64) {
    const RayScene rays = tests::build_rays(scene);
    const auto sources = tests::all_sources(scene);
    glm::dvec3 sum(0);
    std::uint64_t traced = 0;
    for (const LampSources& lamp : sources) {
        sum += straight_irradiance(rays, lamp, receiver, samples, traced);
    }
    return sum;
}

formats::Scene lit_by(Light light) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}), 0.5f);
    scene.lights.push_back(std::move(light));
    return scene;
}

TEST(TriangleIrradiance, OfASquareIsTheClosedForm) {
    const formats::Scene scene = tests::parallel_squares();
    const auto sources = tests::all_sources(scene);
    for (const auto& [s, t] : {std::pair{0.5, 0.5}, {0.1, 0.7}, {0.0, 0.0}, {1.5, 0.2}}) {
        double sum = 0;
        for (const GlowingTriangle& triangle : sources[0].triangles) {
            sum += triangle_irradiance(triangle, {s, t, 1}, {0, 0, -1}) * triangle.radiance.x;
        }
        EXPECT_NEAR(sum, tests::square_irradiance(s, t), 1e-6) << s << ' ' << t;
    }
}

// Half of a square that stands on the horizon counts: the two halves of one that is cut by it add
// up as seen by a normal turned either way.
TEST(TriangleIrradiance, CountsThePartAboveTheHorizon) {
    GlowingTriangle triangle;
    triangle.corner = {glm::dvec3(1, -1, -1), glm::dvec3(1, 1, -1), glm::dvec3(1, 0, 2)};
    triangle.normal = {-1, 0, 0};
    const double up = triangle_irradiance(triangle, glm::dvec3(0), {0, 0, 1});
    const double down = triangle_irradiance(triangle, glm::dvec3(0), {0, 0, -1});
    // The vector of both is the signed sum over the whole triangle.
    double signed_sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 &a = triangle.corner[k], &b = triangle.corner[(k + 1) % 3];
        const glm::dvec3 cross = glm::cross(a, b);
        signed_sum +=
            std::atan2(glm::length(cross), glm::dot(a, b)) * cross.z / glm::length(cross) / 2;
    }
    EXPECT_GT(up, 0);
    EXPECT_GT(down, 0);
    EXPECT_NEAR(std::abs(up - down), std::abs(signed_sum), 1e-12);
    EXPECT_EQ(triangle_irradiance(triangle, {2, 0, 0}, {-1, 0, 0}), 0);  // its back
}

TEST(StraightLight, UnoccludedSquareIsExactWithOneSample) {
    const formats::Scene scene = tests::parallel_squares();
    const glm::dvec3 E = receive(scene, {{0.3f, 0.4f, 0.9999f}, {0, 0, -1}}, 1);
    EXPECT_NEAR(E.x, tests::square_irradiance(0.3, 0.4), 1e-3);
}

// The far quarter of the lamp is hidden.
TEST(StraightLight, PenumbraIsTheVisiblePart) {
    formats::Scene scene = tests::parallel_squares();
    tests::add_surface(scene, tests::make_quad({0.25f, 0.25f, 0.5f}, {10, 0, 0}, {0, 10, 0}), 0);
    scene.primitives[1].position = {{5, 5, 5}, {5, 6, 5}, {6, 5, 5}, {6, 6, 5}};
    // From (0, 0, 1) the blocker's corner is seen at (1/2, 1/2) of the lamp.
    const double seen = 2 * tests::corner_factor(0.5, 1) - tests::corner_factor(0.5, 0.5);
    EXPECT_NEAR(receive(scene, {{0, 0, 1}, {0, 0, -1}}, 4096).x, seen, 0.01 * seen);
}

TEST(StraightLight, PointLightFallsWithTheSquareOfTheDistanceAndTheCosine) {
    const formats::Scene scene =
        lit_by({.name = "", .intensity = {9, 3, 0}, .position = {0, 3, 0}});
    const glm::dvec3 below = receive(scene, {{0, 1e-4f, 0}, {0, 1, 0}});
    EXPECT_NEAR(below.x, 1, 1e-3);
    EXPECT_NEAR(below.y, 1.0 / 3, 1e-3);
    EXPECT_EQ(below.z, 0);
    const glm::dvec3 aside = receive(scene, {{4, 1e-4f, 0}, {0, 1, 0}});
    EXPECT_NEAR(aside.x, 9.0 / 25 * 3 / 5, 1e-3);
    EXPECT_EQ(receive(scene, {{0, 1e-4f, 0}, {0, -1, 0}}).x, 0);
}

// Smoke 0.22 m thick between lamp and receiver, or beyond the lamp: its density falls to 0
// within half a voxel more on either side.
TEST(StraightLight, SmokeBetweenDimsLampsByBeersLaw) {
    formats::Scene scene = lit_by({.name = "", .intensity = {9, 9, 9}, .position = {0, 3, 0}});
    tests::add_surface(scene, tests::make_quad({-0.1f, 2, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}), 0,
                       1);
    const Receiver below{{0, 1e-4f, 0}, {0, 1, 0}};
    const RayScene rays = tests::build_rays(scene);
    std::uint64_t traced = 0;
    for (const double height : {1.0, 3.6}) {
        formats::Volume smoke = tests::make_volume(
            tests::sample_grid({0.6, 0.1, 0.6}, 0.02, [](glm::dvec3) { return 1.0; }), 1, 0, 0);
        smoke.sigma_t = {2, 5, 10};
        smoke.density.to_scene[3] = glm::dvec4(0, height, 0, 1);
        scene.volumes = {smoke};
        const DensitySpace space = make_density_space(scene);
        const glm::dvec3 depth = (height < 2 ? 0.22 : 0.0) * glm::dvec3(2, 5, 10);
        for (const LampSources& lamp : tests::all_sources(scene)) {
            const bool is_quad = !lamp.triangles.empty();
            const Receiver aside = is_quad ? below : Receiver{{0, 2.5f, 0}, {0, 1, 0}};
            const glm::dvec3 bare = straight_irradiance(rays, lamp, aside, 256, traced);
            const glm::dvec3 dim = straight_irradiance(rays, lamp, aside, 256, traced, &space);
            for (int band = 0; band < 3; ++band) {
                const double share = is_quad ? std::exp(-depth[band]) : 1;
                EXPECT_NEAR(dim[band] / bare[band], share, 0.04 * share) << height << band;
            }
        }
    }
}

TEST(StraightLight, DirectionalLightGivesItsLuxTimesTheCosine) {
    Light sun{.type = Light::Type::directional, .name = "", .intensity = {100, 50, 10}};
    sun.direction = glm::normalize(glm::vec3(3, -4, 0));
    const formats::Scene scene = lit_by(sun);
    const glm::dvec3 E = receive(scene, {{0, 1e-3f, 0}, {0, 1, 0}});
    EXPECT_NEAR(E.x, 80, 1e-3);
    EXPECT_NEAR(E.z, 8, 1e-4);
    EXPECT_EQ(receive(scene, {{0, -1, 0}, {0, 1, 0}}).x, 0);  // beneath the floor
}

}  // namespace
}  // namespace opaline::bake
