#include "bake/check/surface_probes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

std::vector<CheckPoint> draw(const formats::Scene& scene, std::size_t count,
                             const std::vector<std::uint32_t>& primitives, unsigned threads = 2) {
    const auto rays = RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    Context context;
    context.threads = threads;
    return draw_surface_probes(scene, *rays, primitives, {count, 5, 1000}, context);
}

TEST(SurfaceProbes, AreSharedOutByAreaAndLieWhereTheirWeightsSay) {
    // Areas 36 and 4.
    const auto scene = tests::make_scene({tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 3),
                                          tests::make_quad({9, 0, 0}, {0, 0, 2}, {2, 0, 0}, 40)});
    const auto probes = draw(scene, 400, {0, 1});
    ASSERT_EQ(probes.size(), 400u);
    std::size_t first = 0;
    glm::dvec3 mean(0);
    const auto vertices = static_cast<std::uint32_t>(scene.primitives[0].position.size());
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const CheckPoint& probe = probes[i];
        glm::vec3 mixed(0);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = probe.vertex[k] - (probe.primitive == 0 ? 0 : vertices);
            EXPECT_GE(probe.weight[k], 0);
            mixed += probe.weight[k] * scene.primitives[probe.primitive].position[v];
        }
        EXPECT_LT(glm::distance(mixed, probe.body.position), 1e-5f);
        EXPECT_NEAR(probe.weight[0] + probe.weight[1] + probe.weight[2], 1, 1e-6);
        EXPECT_EQ(probe.key, 1000 + i);
        if (probe.primitive == 0) {
            ++first;
            mean += glm::dvec3(probe.body.position);
        }
    }
    EXPECT_EQ(first, 360u);  // strata of equal area
    EXPECT_LT(glm::length(mean) / 360, 0.3);
}

TEST(SurfaceProbes, PrimitivesThatAreNotListedGetNone) {
    const auto scene = tests::make_scene({tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}),
                                          tests::make_quad({9, 0, 0}, {0, 0, 2}, {2, 0, 0})});
    for (const CheckPoint& probe : draw(scene, 50, {1})) {
        EXPECT_EQ(probe.primitive, 1u);
    }
    EXPECT_TRUE(draw(scene, 50, {}).empty());
}

TEST(SurfaceProbes, NoneLiesInsideABody) {
    // Half of the ball below the floor's plane: nobody sees the floor within it.
    const auto scene = tests::make_scene(
        {tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), tests::make_sphere(4)});
    const auto probes = draw(scene, 400, {0});
    // pi of 16 are hidden.
    EXPECT_NEAR(static_cast<double>(probes.size()), 400 * (1 - 3.1416 / 16), 32);
    for (const CheckPoint& probe : probes) {
        EXPECT_GT(glm::length(probe.body.position), 0.99f);
    }
}

TEST(SurfaceProbes, NormalsAreThoseOfTheSmoothSurfaceAndTheInnerPointLiesInside) {
    const auto scene = tests::make_scene({tests::make_sphere(2)});
    for (const CheckPoint& probe : draw(scene, 100, {0})) {
        const glm::vec3 out = glm::normalize(probe.body.position);
        EXPECT_GT(glm::dot(probe.body.normal, out), 0.999f);
        EXPECT_EQ(probe.body.normal, probe.receiver.normal);
        EXPECT_GT(glm::dot(probe.receiver.origin - probe.body.position, out), 0);
        EXPECT_LT(glm::dot(probe.body.inner - probe.body.position, out), 0);
        EXPECT_LT(glm::distance(probe.body.inner, probe.body.position), 1e-4f);
    }
}

}  // namespace
}  // namespace opaline::bake
