#include "bake/trace/irradiance_transport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/receivers/vertex_receivers.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using tests::build_rays;
using tests::white_irradiance;

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
    const RayScene sky = build_rays({});
    const DirectionSet directions = make_direction_set(8);
    const Receiver receiver{{0, 0, 0}, {0, 1, 0}};
    const std::vector<std::vector<float>> factor{{1.0f, 1.0f}};
    std::vector<float> banded(formats::cubemap_texels(8)), plain(banded.size());
    EXPECT_EQ(gather_banded_irradiance(sky, directions, receiver, factor, banded), 0u);
    EXPECT_EQ(gather_irradiance(sky, directions, receiver, plain), 0u);
    EXPECT_EQ(banded, plain);
    const RayScene floor =
        build_rays(tests::make_scene({tests::make_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0})}));
    EXPECT_GT(gather_banded_irradiance(floor, directions, receiver, factor, banded), 0u);
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
            worst = std::max(worst, std::abs(white_irradiance(build_rays(scene), centre, n) - 1));
        }
        EXPECT_LT(worst, previous) << n;
        if (n == 32) {
            EXPECT_LT(worst, 1e-3);
        }
        previous = worst;
    }
}

// From a differential area: a perpendicular wall, infinitely long, of height h at distance a takes
// F = (1 - a / sqrt(a^2 + h^2)) / 2, half of the hemisphere for a high wall at its foot; a parallel
// disc r^2 / (r^2 + h^2); a sphere wholly above the horizon cos(theta) (r/d)^2, d the distance of
// its centre.
TEST(IrradianceTransport, ThingsTakeTheirFormFactor) {
    const auto expect_left = [](const tests::Primitive& thing, glm::vec3 at, double taken,
                                double error) {
        const RayScene rays = build_rays(tests::make_scene({thing}));
        EXPECT_NEAR(white_irradiance(rays, {at, {0, 1, 0}}, 64), 1 - taken, error)
            << thing.name << ' ' << at.x << ' ' << at.z;
    };
    const auto wall = tests::make_quad({-100, 0, 0}, {200, 0, 0}, {0, 20, 0});
    for (const float a : {0.001f, 5.0f}) {
        // Its ends, at 100 m, leave less than 0.2 percent open.
        expect_left(wall, {0, 0, a}, 0.5 * (1 - a / std::sqrt(a * a + 400)), 4e-3);
    }
    for (const float height : {0.5f, 1.0f, 2.0f}) {
        // A texel of its edge is wholly in or out: N = 64 resolves 128 rays per face.
        expect_left(tests::make_disc(1, height, 720), {0, 0, 0}, 1 / (1 + height * height), 3e-3);
    }
    const glm::vec3 centre(0, 1.5f, 0);
    for (const float x : {0.0f, 0.4f, 0.9f}) {
        const double d = glm::length(centre - glm::vec3(x, 0, 0));
        expect_left(tests::make_sphere(5, 1, centre), {x, 0, 0}, centre.y / d / (d * d), 3e-3);
    }
}

TEST(IrradianceTransport, ReceiverWithoutANormalGathersNothingAndTracesNothing) {
    const auto scene = tests::make_scene({tests::make_sphere(1)});
    const RayScene rays = build_rays(scene);
    std::vector<float> transport(formats::cubemap_texels(8), 1.0f);
    EXPECT_EQ(gather_irradiance(rays, make_direction_set(8), {{2, 0, 0}, {0, 0, 0}}, transport),
              0u);
    for (const float value : transport) {
        ASSERT_EQ(value, 0.0f);
    }
}

}  // namespace
}  // namespace opaline::bake
