// Copies of a mesh hide and mirror what the same triangles hide there.
#include <gtest/gtest.h>

#include <limits>

#include "bake/base/rng.h"
#include "bake/scene/copies.h"
#include "bake/trace/packet_lane.h"
#include "bake/trace/touching_triangles.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// A ball with dents twice more, and a floor.
formats::Scene make_copies() {
    formats::Primitive ball = tests::make_sphere(2);
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        ball.position[v] *= 1 + 0.2f * std::sin(5 * ball.normal[v].x);
    }
    formats::Scene scene = tests::make_scene(
        {ball, {}, tests::make_quad({-9, -1.5f, -9}, {0, 0, 18}, {18, 0, 0}), {}});
    scene.primitives[1].copy = {0, {3, 0, 0.5f}};
    scene.primitives[3].copy = {0, {-2, 1, -4}};
    return scene;
}

formats::Scene expanded(formats::Scene scene) {
    expand_copies(find_copied_meshes(scene), scene);
    return scene;
}

TEST(Copies, RaysMeetThemAsTheSameTriangles) {
    const formats::Scene copies = make_copies(), whole = expanded(copies);
    ASSERT_EQ(whole.primitives[3].position.size(), copies.primitives[0].position.size());
    const RayScene a = RayScene::build(copies, 1).value(), b = RayScene::build(whole, 1).value();
    EXPECT_EQ(a.triangles(), b.triangles());
    EXPECT_EQ(a.hierarchy().low(), b.hierarchy().low());
    EXPECT_EQ(a.hierarchy().high(), b.hierarchy().high());
    int met = 0, other = 0;
    for (std::uint32_t ray = 0; ray < 20000; ++ray) {
        const auto u = random_uniform(1, RandomStage::reference_path, ray, 0),
                   w = random_uniform(1, RandomStage::reference_path, ray, 1);
        const glm::vec3 from = 12.0f * glm::vec3(u[0], u[1], u[2]) - 6.0f;
        const glm::vec3 way = glm::normalize(glm::vec3(w[0], w[1], w[2]) - 0.5f);
        const PacketHits in = closest_of_one(a, from, way), of = closest_of_one(b, from, way);
        if (in.hit[0] != of.hit[0]) {  // along an edge, by rounding
            ++other;
            continue;
        }
        if (in.hit[0] == 0) continue;
        ++met;
        const std::uint32_t number = of.primitive[0];
        const formats::CopyOf& copy = copies.primitives[number].copy;
        EXPECT_NEAR(in.distance[0], of.distance[0], 1e-4f);
        EXPECT_EQ(in.primitive[0], copies.primitives[number].is_copy() ? copy.primitive : number);
        EXPECT_EQ(in.offset[0], copy.offset);
        EXPECT_EQ(is_hidden(a, from, way, std::numeric_limits<float>::infinity()), true);
    }
    EXPECT_GT(met, 5000);
    EXPECT_LT(other, 20);
}

TEST(Copies, TrianglesThatTouchAPointAreFound) {
    const formats::Scene copies = make_copies(), whole = expanded(copies);
    const EmbreeScene a = EmbreeScene::build(copies, 1).value(),
                      b = EmbreeScene::build(whole, 1).value();
    for (std::size_t v = 0; v < whole.primitives[1].position.size(); v += 7) {
        const glm::vec3 at = whole.primitives[1].position[v];
        const auto in = find_touching_triangles(a, copies, at, 1e-3f);
        const auto of = find_touching_triangles(b, whole, at, 1e-3f);
        ASSERT_EQ(in.size(), of.size());
        for (std::size_t t = 0; t < in.size(); ++t) {
            EXPECT_EQ(in[t].triangle, of[t].triangle);
            EXPECT_TRUE(in[t].is_corner);
        }
    }
}

}  // namespace
}  // namespace opaline::bake
