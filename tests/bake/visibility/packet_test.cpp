#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "bake/trace/ray_scene.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// Rays of one direction from points in a small part of a body, some of them from behind the first
// surface, as for undecided look-ups of a light map.
TEST(RayPackets, MeetTheNearestTriangleBeyondTheirStart) {
    const auto scene = tests::make_scene({tests::make_sphere(2, 1), tests::make_sphere(2, 0.9f)});
    const RayScene rays = tests::build_rays(scene);
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    const auto random = [&] {
        return glm::vec3(normal(generator), normal(generator), normal(generator));
    };
    int met = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const glm::vec3 direction = glm::normalize(random());
        const glm::vec3 centre = 0.94f * glm::normalize(random());
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
            packet.tnear[lane] = lane % 2 == 0 ? 0.0f : 0.2f;
            lanes[lane] = lane < 11 ? -1 : 0;
        }
        const PacketHits hits = rays.closest(lanes, packet);
        for (std::uint32_t lane = 0; lane < 11; ++lane) {
            const glm::dvec3 origin(packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]);
            const double nearest =
                tests::brute_force_distance(scene, origin, direction, packet.tnear[lane]);
            ASSERT_EQ(hits.hit[lane] != 0, std::isfinite(nearest)) << trial << ' ' << lane;
            if (std::isfinite(nearest)) {
                EXPECT_NEAR(hits.distance[lane], nearest, 1e-4) << trial << ' ' << lane;
                ++met;
            }
        }
    }
    EXPECT_GT(met, 1000);
}

}  // namespace
}  // namespace opaline::bake
