#include "bake/scene/separate_bodies.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// `primitives` of one material; the others of another.
formats::Scene of_one_material(std::vector<tests::Primitive> primitives) {
    return tests::make_scene(std::move(primitives));
}

tests::Primitive ball_at(glm::vec3 at, float radius = 1) {
    tests::Primitive ball = tests::make_sphere(2, radius);
    for (glm::vec3& p : ball.position) {
        p += at;
    }
    return ball;
}

std::uint32_t count(std::vector<tests::Primitive> primitives) {
    return SeparateBodies(of_one_material(std::move(primitives)), 0).count();
}

TEST(SeparateBodies, WithAirBetweenThemAreTwo) {
    EXPECT_EQ(count({ball_at({0, 0, 0})}), 1u);
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({2.1f, 0, 0})}), 2u);
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({1.5f, 1.5f, 0})}), 2u) << "boxes overlap";
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({1.25f, 1.25f, 1.25f})}), 2u);
    EXPECT_EQ(count({}), 0u);
}

TEST(SeparateBodies, ThatTouchOverlapOrAreHollowAreOne) {
    tests::Primitive a = tests::make_cube(2, false), b = a, away = a;
    const float edge = a.position[0].x * 2;
    for (glm::vec3& p : b.position) {
        p.x += std::abs(edge);
    }
    for (glm::vec3& p : away.position) {
        p.x -= 2 * std::abs(edge);
    }
    EXPECT_EQ(count({a, b}), 1u);
    EXPECT_EQ(count({away, a, b}), 2u);
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({1, 0, 0})}), 1u);
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({0, 0, 0}, 0.9f)}), 1u);
    // By way of a third one.
    EXPECT_EQ(count({ball_at({0, 0, 0}), ball_at({3, 0, 0}), ball_at({1.5f, 0, 0})}), 1u);
}

TEST(SeparateBodies, EveryPointOfASurfaceBelongsToItsOwn) {
    std::vector<tests::Primitive> balls;
    for (int i = 0; i < 27; ++i) {
        balls.push_back(
            ball_at(2.2f * glm::vec3(i % 3, i / 3 % 3, i / 9) + glm::vec3(1000, -1000, 0)));
    }
    const formats::Scene scene = of_one_material(balls);
    const SeparateBodies bodies(scene, 0);
    ASSERT_EQ(bodies.count(), 27u);
    for (const formats::Primitive& ball : scene.primitives) {
        const std::uint32_t own = bodies.body_at(ball.position[0]);
        for (std::size_t i = 0; i + 2 < ball.index.size(); i += 3) {
            const glm::vec3 middle =
                (ball.position[ball.index[i]] + ball.position[ball.index[i + 1]] +
                 ball.position[ball.index[i + 2]]) /
                3.0f;
            ASSERT_EQ(bodies.body_at(middle), own);
            ASSERT_EQ(bodies.body_at(ball.position[ball.index[i]]), own);
        }
    }
}

// One triangle after the other, in a heap.
TEST(SeparateBodies, ManyPartsEndSoon) {
    tests::Primitive soup;
    for (std::uint32_t i = 0; i < 60000; ++i) {
        const glm::vec3 at(static_cast<float>(i % 7) * 1e-3f, static_cast<float>(i), 0);
        for (const glm::vec3 corner : {glm::vec3(0), glm::vec3(50000, 0, 0), glm::vec3(0, 0, 1)}) {
            soup.position.push_back(at + corner);
            soup.normal.emplace_back(0, 1, 0);
            soup.index.push_back(3 * i + static_cast<std::uint32_t>(soup.index.size() % 3));
        }
    }
    EXPECT_GE(count({soup}), 1u);
}

}  // namespace
}  // namespace opaline::bake
