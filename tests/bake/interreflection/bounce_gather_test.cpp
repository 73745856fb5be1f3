#include "bake/effects/interreflection/bounce_gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/interreflection/scatterers.h"
#include "bake/path_differentials/path_differential.h"
#include "formats/opal/haar.h"
#include "tests/bake/interreflection/bounce_support.h"

namespace opaline::bake {
namespace {

std::vector<Scatterer> upper_plate(std::uint32_t side) {
    std::vector<Scatterer> all;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        Scatterer s;
        s.position = {(static_cast<float>(i % side) + 0.5f) / static_cast<float>(side), 1,
                      (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side)};
        s.normal = {0, -1, 0};
        s.material = 1;
        all.push_back(s);
    }
    return all;
}

// Form factor from the middle of a square to a parallel one at distance 1 and of edge 1: four
// times that of a corner, X = Y = 1/2:
//   F = 4 / (2 pi) (X / sqrt(1 + X^2) atan(Y / sqrt(1 + X^2)) + the same with X and Y exchanged).
TEST(BounceGather, SumOfWeightsIsTheFormFactor) {
    const formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceTree tree(upper_plate(32), 2, 1);
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double expected = 4 / std::numbers::pi * x / root * std::atan(x / root);
    double sum = 0;
    std::vector<NodeWeight> weights;
    EXPECT_EQ(weigh_bounces(scene, rays, tree, {{0.5f, 1e-5f, 0.5f}, {0, 1, 0}}, 4096, 1, weights),
              4096u);
    for (const NodeWeight& w : weights) {
        sum += w.weight;
    }
    EXPECT_NEAR(sum, expected, 0.003);
}

// From a plate that looks away there is nothing to see.
TEST(BounceGather, BacksOfSingleSidedSurfacesSendNothing) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceTree tree(upper_plate(4), 2, 1);
    std::vector<NodeWeight> weights;
    weigh_bounces(scene, rays, tree, {{0.5f, 2, 0.5f}, {0, -1, 0}}, 256, 1, weights);
    EXPECT_TRUE(weights.empty());
}

// The scalar that the gather uses is the polygon that path_differentials carries along the ray.
TEST(BounceGather, FootprintIsThatOfThePathDifferential) {
    for (std::uint32_t i = 0; i < 200; ++i) {
        const auto u = random_uniform(9, RandomStage::bounce_rays, i);
        const auto w = random_uniform(9, RandomStage::bounce_rays, i, 1);
        const double count = 1e8, t = 0.2 + 3 * w[0];  // secants become tangents
        PathDifferential path;
        DifferentialRules rules;
        rules.extent = 1e6;
        LobeEvent event;
        event.u = 0.02 + 0.96 * u[0];
        event.v = 0.02 + 0.96 * u[1];
        event.step_u = event.step_v = 1 / std::sqrt(count);
        const glm::dvec3 D = scatter_in_lobe(path, rules, event);
        const glm::dvec3 N_g = glm::normalize(glm::dvec3(0.3 * u[2], 0.3 * u[3], 1) - 2.0 * D);
        move_to_surface(path, D, N_g, t);
        const double area = surface_footprint(path, rules, N_g, FootprintMode::polygon).area;
        const double scalar = std::numbers::pi * t * t / (count * D.z * std::abs(glm::dot(D, N_g)));
        EXPECT_NEAR(area / scalar, 1, 1e-4) << i;
    }
}

// Coefficients of a coarse map, put into a finer one, are those of the same map.
TEST(BounceGather, FinerMapsAreTheSameMap) {
    constexpr std::uint32_t m = 8, n = 32;
    std::vector<float> coarse(6 * m * m), fine(6 * n * n), expected(6 * n * n);
    for (std::size_t k = 0; k < coarse.size(); ++k) {
        coarse[k] = std::sin(static_cast<float>(k));
    }
    for (std::size_t face = 0; face < 6; ++face) {
        for (std::size_t i = 0; i < n * n; ++i) {
            expected[face * n * n + i] = coarse[(face * m + i / n * m / n) * m + i % n * m / n];
        }
    }
    formats::haar_forward_cube(std::span<float>(expected), n);
    formats::haar_forward_cube(std::span<float>(coarse), m);
    add_to_finer(coarse, m, fine, n, 1);
    for (std::size_t k = 0; k < fine.size(); ++k) {
        EXPECT_NEAR(fine[k], expected[k], 1e-4);
    }
}

}  // namespace
}  // namespace opaline::bake
