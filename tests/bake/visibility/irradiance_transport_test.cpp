#include "bake/transport/irradiance_transport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bake/receivers/vertex_receivers.h"
#include "bake/transport/banded_irradiance.h"
#include "formats/opal/cubemap.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// Irradiance of unit radiance from everywhere, divided by pi: radiance over albedo.
double radiance_under_white(const formats::Scene& scene, const Receiver& receiver,
                            std::uint32_t n) {
    const auto rays = RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    std::vector<float> transport(formats::cubemap_texels(n));
    gather_irradiance(*rays, make_direction_set(n), receiver, transport);
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    double sum = 0;
    for (std::size_t j = 0; j < transport.size(); ++j) {
        sum += transport[j] * solid_angle[j % solid_angle.size()];
    }
    return sum / std::numbers::pi;
}

std::vector<glm::vec3> random_normals(int count) {
    std::mt19937 generator(11);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> normals;
    for (int i = 0; i < count; ++i) {
        normals.push_back(
            glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator))));
    }
    return normals;
}

TEST(BandedIrradiance, NothingIsTracedWhereThereIsNothingToHit) {
    const auto sky = RayScene::build({}, 1);
    ASSERT_TRUE(sky);
    const DirectionSet directions = make_direction_set(8);
    const Receiver receiver{{0, 0, 0}, {0, 1, 0}};
    const std::vector<std::vector<float>> factor{{1.0f, 1.0f}};
    std::vector<float> banded(formats::cubemap_texels(8)), plain(banded.size());
    EXPECT_EQ(gather_banded_irradiance(*sky, directions, receiver, factor, banded), 0u);
    EXPECT_EQ(gather_irradiance(*sky, directions, receiver, plain), 0u);
    EXPECT_EQ(banded, plain);
    const auto floor = RayScene::build(
        tests::make_scene({tests::make_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0})}), 1);
    EXPECT_GT(gather_banded_irradiance(*floor, directions, receiver, factor, banded), 0u);
}

// A plane sees half of all directions, whatever way the cube map lies: <max(0, n.w), 1> = pi.
TEST(IrradianceTransport, OpenPlaneUnderWhiteReflectsItsAlbedo) {
    double previous = 1;
    for (const std::uint32_t n : {8u, 16u, 32u, 64u}) {
        double worst = 0;
        for (const glm::vec3 normal : random_normals(20)) {
            const glm::vec3 a = glm::normalize(glm::cross(normal, glm::vec3(0.31f, 0.2f, 0.93f)));
            const glm::vec3 b = glm::cross(normal, a);
            const auto scene =
                tests::make_scene({tests::make_quad(-5.0f * (a + b), 10.0f * a, 10.0f * b, 2)});
            const Receiver centre = make_vertex_receivers(scene)[4];
            worst = std::max(worst, std::abs(radiance_under_white(scene, centre, n) - 1));
        }
        EXPECT_LT(worst, previous) << n;
        if (n == 32) {
            EXPECT_LT(worst, 1e-3);
        }
        previous = worst;
    }
}

TEST(IrradianceTransport, EveryVertexOfASphereUnderWhiteReflectsItsAlbedo) {
    const auto scene = tests::make_scene({tests::make_sphere(3, 0.02f, {3, -2, 5})});
    for (const Receiver& receiver : make_vertex_receivers(scene)) {
        ASSERT_NEAR(radiance_under_white(scene, receiver, 32), 1, 1e-3);
    }
}

// Differential area to a perpendicular wall, infinitely long, of height h at distance a:
// F = (1 - a / sqrt(a^2 + h^2)) / 2; half of the hemisphere for a high wall at its foot.
TEST(IrradianceTransport, WallHalvesTheIrradianceAtItsFoot) {
    const auto scene = tests::make_scene({tests::make_quad({-100, 0, 0}, {200, 0, 0}, {0, 20, 0})});
    for (const float a : {0.001f, 5.0f}) {
        const Receiver foot{{0, 0, a}, {0, 1, 0}};
        const double expected = 1 - 0.5 * (1 - a / std::sqrt(a * a + 400));
        // The wall's ends, at 100 m, leave less than 0.2 percent open.
        EXPECT_NEAR(radiance_under_white(scene, foot, 64), expected, 4e-3) << a;
    }
}

// Differential area to parallel disc: F = r^2 / (r^2 + h^2).
TEST(IrradianceTransport, DiscOverheadTakesItsFormFactor) {
    const Receiver below{{0, 0, 0}, {0, 1, 0}};
    for (const float height : {0.5f, 1.0f, 2.0f}) {
        const auto scene = tests::make_scene({tests::make_disc(1, height, 720)});
        const double expected = 1 - 1 / (1 + height * height);
        // A texel of the disc's edge is wholly in or out: N = 64 resolves 128 rays per face.
        EXPECT_NEAR(radiance_under_white(scene, below, 64), expected, 3e-3) << height;
    }
}

// A sphere wholly above the horizon takes cos(theta) (r/d)^2, d the distance of its centre.
TEST(IrradianceTransport, SphereOverAPlaneTakesItsFormFactor) {
    const glm::vec3 centre(0, 1.5f, 0);
    const auto scene = tests::make_scene({tests::make_sphere(5, 1, centre)});
    for (const float x : {0.0f, 0.4f, 0.9f}) {
        const Receiver below{{x, 0, 0}, {0, 1, 0}};
        const double d = glm::length(centre - below.origin);
        ASSERT_GT(centre.y, 1.0f);
        const double expected = 1 - centre.y / d / (d * d);
        EXPECT_NEAR(radiance_under_white(scene, below, 64), expected, 3e-3) << x;
    }
}

TEST(IrradianceTransport, ReceiverWithoutANormalGathersNothingAndTracesNothing) {
    const auto scene = tests::make_scene({tests::make_sphere(1)});
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays);
    std::vector<float> transport(formats::cubemap_texels(8), 1.0f);
    EXPECT_EQ(gather_irradiance(*rays, make_direction_set(8), {{2, 0, 0}, {0, 0, 0}}, transport),
              0u);
    for (const float value : transport) {
        ASSERT_EQ(value, 0.0f);
    }
}

// Turning scene and receiver by 90 degrees about y turns the cube map: its texels are permuted.
TEST(IrradianceTransport, QuarterTurnOfTheSceneTurnsTheTexels) {
    const std::uint32_t n = 16;
    const glm::mat3 turn(glm::vec3(0, 0, -1), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0));
    const auto sphere = tests::make_sphere(2, 0.6f, {0.2f, 1.3f, 0.4f});
    const Receiver receiver{{0.1f, 0.05f, -0.3f}, glm::normalize(glm::vec3(0.1f, 1, 0.3f))};
    const Receiver turned{turn * receiver.origin, turn * receiver.normal};
    const auto rays = RayScene::build(tests::make_scene({sphere}), 1);
    const auto turned_rays =
        RayScene::build(tests::make_scene({tests::transformed(sphere, turn, 1, glm::vec3(0))}), 1);
    ASSERT_TRUE(rays && turned_rays);
    const DirectionSet directions = make_direction_set(n);
    std::vector<float> a(formats::cubemap_texels(n)), b(a.size());
    gather_irradiance(*rays, directions, receiver, a);
    gather_irradiance(*turned_rays, directions, turned, b);
    double difference = 0, sum = 0;
    for (std::uint32_t j = 0; j < a.size(); ++j) {
        const formats::Vec3 d = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        const glm::vec3 w = turn * glm::vec3(d.x, d.y, d.z);
        difference += std::abs(a[j] - b[formats::texel_index(n, {w.x, w.y, w.z})]);
        sum += a[j];
    }
    EXPECT_LT(difference / sum, 1e-5);
}

}  // namespace
}  // namespace opaline::bake
