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
