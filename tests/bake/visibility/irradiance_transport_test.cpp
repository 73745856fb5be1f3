#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
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

// Integral of max(0, n.w) over the subtexel by 16 x 16 midpoints on the cube, where it lies above
// the horizon; the pipeline's stated rule for the rest: the positive part of the whole integral.
double cosine_integral(glm::dvec3 normal, std::uint32_t face, double u0, double v0, double size) {
    constexpr int kPoints = 16;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        for (int j = 0; j < kPoints; ++j) {
            const double u = u0 + size * (i + 0.5) / kPoints, v = v0 + size * (j + 0.5) / kPoints;
            const formats::Vec3 axis = formats::cube_position({face, 0, 0});
            const formats::Vec3 du = formats::cube_position({face, 1, 0}) - axis;
            const formats::Vec3 dv = formats::cube_position({face, 0, 1}) - axis;
            const glm::dvec3 p = glm::dvec3(axis.x, axis.y, axis.z) +
                                 u * glm::dvec3(du.x, du.y, du.z) +
                                 v * glm::dvec3(dv.x, dv.y, dv.z);
            const double r2 = glm::dot(p, p);
            // dOmega = du dv / r^3, cosine = n.p / r.
            sum += glm::dot(normal, p) / (r2 * r2);
        }
    }
    return std::max(0.0, sum * size * size / (kPoints * kPoints));
}

// Every ray against every triangle in double precision, every coefficient kept, nothing quantised.
TEST(BruteForce, DenseDoublePrecisionAgreesWithThePipelineToOnePartIn100000) {
    const std::uint32_t n = 16;
    const auto scene =
        tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 3),
                           tests::transformed(tests::make_cube(1, false), tests::some_rotation(),
                                              0.45f, {0.31f, 0.97f, -0.17f}),
                           tests::make_sphere(2, 0.37f, {-0.83f, 0.71f, 0.59f})});
    const RayScene rays = tests::build_rays(scene);
    const DirectionSet directions = make_direction_set(n);
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    const std::vector<Receiver> receivers = make_vertex_receivers(scene);

    std::mt19937 generator(3);
    std::exponential_distribution<double> exponential;
    std::vector<double> light(formats::cubemap_texels(n));
    for (std::size_t j = 0; j < light.size(); ++j) {
        light[j] = exponential(generator) * solid_angle[j % solid_angle.size()];
    }
    std::vector<double> light_vector = light;
    formats::haar_forward_cube(std::span(light_vector), n);

    for (std::size_t r = 0; r < receivers.size(); r += 13) {
        std::vector<float> row(light.size());
        gather_irradiance(rays, directions, receivers[r], row);
        formats::haar_forward_cube(std::span(row), n);
        double relit = 0;
        for (std::size_t k = 0; k < row.size(); ++k) {
            relit += row[k] * light_vector[k];
        }
        double expected = 0;
        const glm::dvec3 normal = receivers[r].normal, origin = receivers[r].origin;
        for (std::uint32_t s = 0; s < 4 * light.size(); ++s) {
            const std::uint32_t face = s / (4 * n * n), i = s / (2 * n) % (2 * n), j = s % (2 * n);
            const double step = 1.0 / n, u = j * step - 1, v = i * step - 1;
            const double cosine = cosine_integral(normal, face, u, v, step);
            if (cosine <= 0) continue;
            const formats::Vec3 w = formats::cube_position(
                {face, static_cast<float>(u + step / 2), static_cast<float>(v + step / 2)});
            const bool blocked =
                std::isfinite(tests::brute_force_distance(scene, origin, {w.x, w.y, w.z}, 0));
            const std::size_t texel = (face * n + i / 2) * n + j / 2;
            const double radiance = light[texel] / solid_angle[texel % solid_angle.size()];
            expected += blocked ? 0 : cosine * radiance;
        }
        ASSERT_GT(expected, 0);
        EXPECT_NEAR(relit / expected, 1, 1e-5) << "receiver " << r;
    }
}

}  // namespace

}  // namespace opaline::bake
