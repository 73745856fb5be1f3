#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "bake/visibility/ray_scene.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

formats::Scene dented_balls() {
    std::vector<tests::Primitive> balls;
    for (const float radius : {1.0f, 0.97f, 0.5f}) {
        auto ball = tests::make_sphere(5, radius);
        for (std::size_t v = 0; v < ball.position.size(); ++v) {
            const glm::vec3 n = ball.normal[v];
            ball.position[v] +=
                0.08f * std::sin(13 * n.x) * std::sin(11 * n.y) * std::sin(12 * n.z) * n;
        }
        balls.push_back(ball);
    }
    return tests::make_scene(balls);
}

// Packets of rays with one direction, from places in a small part of a body, some of them from the
// second hit on: what a light map's doubtful columns ask for.
TEST(RayPackets, EachRayMeetsWhatItMeetsAlone) {
    const auto rays = RayScene::build(dented_balls(), 1);
    ASSERT_TRUE(rays);
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    std::uniform_int_distribution<int> coin(0, 1);
    int different = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const auto random = [&] {
            return glm::vec3(normal(generator), normal(generator), normal(generator));
        };
        const glm::vec3 direction = glm::normalize(random());
        const glm::vec3 centre = 0.98f * glm::normalize(random());
        RayPacket packet{};
        packet.mask.fill(0xffffffffu);
        packet.dir_x.fill(direction.x);
        packet.dir_y.fill(direction.y);
        packet.dir_z.fill(direction.z);
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        LaneMask lanes;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::vec3 origin = centre + 0.02f * random();
            packet.org_x[lane] = origin.x;
            packet.org_y[lane] = origin.y;
            packet.org_z[lane] = origin.z;
            packet.tnear[lane] = coin(generator) != 0 ? 0.05f : 0.0f;
            lanes[lane] = lane < 11 ? -1 : 0;
        }
        const PacketHits together = rays->closest(lanes, packet);
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            LaneMask one{};
            one[0] = lanes[lane];
            RayPacket single{};  // the other lanes are zero, their directions, too
            single.mask.fill(0xffffffffu);
            single.org_x[0] = packet.org_x[lane];
            single.org_y[0] = packet.org_y[lane];
            single.org_z[0] = packet.org_z[lane];
            single.dir_x[0] = direction.x;
            single.dir_y[0] = direction.y;
            single.dir_z[0] = direction.z;
            single.tnear[0] = packet.tnear[lane];
            single.tfar[0] = packet.tfar[lane];
            const PacketHits alone = rays->closest(one, single);
            different +=
                together.hit[lane] != alone.hit[0] || together.distance[lane] != alone.distance[0]
                    ? 1
                    : 0;
        }
    }
    EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace opaline::bake
