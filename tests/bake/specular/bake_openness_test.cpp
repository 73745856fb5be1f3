#include "bake/trace/bake_openness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "bake/receivers/vertex_receivers.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

OpenHemisphere gather(const formats::Scene& scene, const Receiver& receiver, std::uint32_t n = 32) {
    const auto rays = RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    OpenHemisphere seen;
    gather_openness(*rays, make_sparse_direction_set(n, 0), {&receiver, 1}, {&seen, 1});
    return seen;
}

float degrees_between(glm::vec3 a, glm::vec3 b) {
    return 180 * std::numbers::inv_pi_v<float> *
           std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(BakeOpenness, OpenPlaneSeesAllOfItsHemisphereAroundItsNormal) {
    for (const glm::vec3 n : {glm::vec3(0, 1, 0), glm::vec3(-1, 0, 0),
                              glm::vec3(0.48f, -0.6f, 0.64f), glm::vec3(0.36f, 0.48f, -0.8f)}) {
        const glm::vec3 a = glm::normalize(glm::cross(n, glm::vec3(0.31f, 0.2f, 0.93f)));
        const glm::vec3 b = glm::cross(n, a);
        const auto scene =
            tests::make_scene({tests::make_quad(-5.0f * (a + b), 10.0f * a, 10.0f * b, 2)});
        const OpenHemisphere seen = gather(scene, make_vertex_receivers(scene)[4]);
        EXPECT_EQ(seen.fraction, 1.0f);
        EXPECT_LT(degrees_between(seen.axis, n), 0.2f);  // a texel is 2.8 degrees wide
        EXPECT_GT(seen.rays, 2000u);
    }
}

// A wall of height h at distance a takes (1 - a / sqrt(a^2 + h^2)) / 2. At the foot of a high one
// half is left, and its mean direction leans from the normal by atan(2 / pi): over the quarter
// sphere int c^2 dw = pi/3 along the normal and int c (w.away) dw = 2/3 away from the wall.
TEST(BakeOpenness, WallTakesItsFormFactorAndTurnsTheMeanDirectionAway) {
    const auto scene = tests::make_scene({tests::make_quad({-100, 0, 0}, {200, 0, 0}, {0, 20, 0})});
    for (const float a : {0.001f, 5.0f}) {
        const OpenHemisphere seen = gather(scene, {{0, 0, a}, {0, 1, 0}});
        // One ray a texel of 2.8 degrees along the wall's edge; its ends leave 0.2 percent open.
        EXPECT_NEAR(seen.fraction, 1 - 0.5 * (1 - a / std::sqrt(a * a + 400)), 0.01) << a;
    }
    const OpenHemisphere foot = gather(scene, {{0, 0, 0.001f}, {0, 1, 0}});
    const float lean = std::atan(2 * std::numbers::inv_pi_v<float>);
    EXPECT_LT(degrees_between(foot.axis, {0, std::cos(lean), std::sin(lean)}), 1.0f);
}

TEST(BakeOpenness, InsideAClosedBodyNothingIsOpen) {
    const auto scene = tests::make_scene({tests::make_sphere(3, 1, {0, 0, 0})});
    const OpenHemisphere seen = gather(scene, {{0.1f, 0, 0}, {0, 0, 1}});
    EXPECT_EQ(seen.fraction, 0.0f);
    EXPECT_EQ(seen.axis, glm::vec3(0, 0, 1));
}

TEST(BakeOpenness, ReceiversWithoutANormalAreClosed) {
    const auto scene = tests::make_scene({tests::make_sphere(2, 1, {0, 0, 0})});
    const OpenHemisphere seen = gather(scene, {{5, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(seen.fraction, 0.0f);
    EXPECT_EQ(seen.rays, 0u);
}

TEST(BakeOpenness, RecordsHoldTheGatheredValuesForAnyNumberOfThreads) {
    const auto scene = tests::make_scene({tests::make_sphere(3, 1, {0, 1, 0}),
                                          tests::make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 8)});
    const auto rays = RayScene::build(scene, 1);
    ASSERT_TRUE(rays);
    const std::vector<Receiver> receivers = make_vertex_receivers(scene);
    const DirectionSet directions = make_sparse_direction_set(16, 0);
    std::uint64_t traced = 0, traced_by_three = 0;
    Context context;
    context.threads = 1;
    const auto one = bake_openness(*rays, directions, receivers, context, traced);
    context.threads = 3;
    const auto three = bake_openness(*rays, directions, receivers, context, traced_by_three);
    ASSERT_EQ(one.size(), receivers.size());
    ASSERT_EQ(three.size(), receivers.size());
    EXPECT_EQ(std::memcmp(one.data(), three.data(), one.size() * sizeof(one[0])), 0);
    EXPECT_EQ(traced, traced_by_three);
    std::size_t shadowed = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        OpenHemisphere seen;
        gather_openness(*rays, directions, {&receivers[i], 1}, {&seen, 1});
        EXPECT_NEAR(formats::open_fraction(one[i]), seen.fraction, 1.01 / 255);
        const formats::Vec3 axis = formats::open_axis(one[i]);
        EXPECT_LT(degrees_between({axis.x, axis.y, axis.z}, seen.axis), 1.0f);
        shadowed += seen.fraction < 0.99f ? 1u : 0u;
    }
    EXPECT_GT(shadowed, 20u);
}

}  // namespace
}  // namespace opaline::bake
