#include "bake/effects/multiple/walks/find_hit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

// Evenly around, more than one packet of rays and no multiple of it.
std::vector<glm::vec3> directions_around() {
    std::vector<glm::vec3> directions;
    for (int i = 0; i < 45; ++i) {
        const float z = 1 - (2 * static_cast<float>(i) + 1) / 45,
                    angle = 2.4f * static_cast<float>(i);
        const float s = std::sqrt(1 - z * z);
        directions.emplace_back(s * std::cos(angle), s * std::sin(angle), z);
    }
    return directions;
}

TEST(FindHit, SeveralFlightsMeetWhatEachMeetsByItself) {
    const auto body = make_walked_body(make_sphere(3), make_forward_medium(1, 0.9f, 0, 1.3f));
    const std::vector<glm::vec3> directions = directions_around();
    for (const glm::vec3 origin : {glm::vec3(0.2f, -0.5f, 0.1f), glm::vec3(3, 0, 0)}) {
        const auto hits = bake::find_hits(body->space, origin, directions);
        ASSERT_EQ(hits.size(), directions.size());
        for (std::size_t i = 0; i < directions.size(); ++i) {
            bake::WalkHit alone;
            const bool meets = bake::find_hit(body->space, origin, directions[i],
                                              std::numeric_limits<float>::infinity(), alone);
            ASSERT_EQ(hits[i].has_value(), meets) << i;
            if (meets) {
                EXPECT_EQ(hits[i]->first_index, alone.first_index) << i;
                EXPECT_LT(glm::distance(hits[i]->position, alone.position), 1e-5f) << i;
                EXPECT_EQ(hits[i]->flat, alone.flat) << i;
            }
        }
    }
}

TEST(FindHit, PointsAreSeenUpToTheFirstTriangle) {
    const auto body = make_walked_body(make_sphere(3), make_forward_medium(1, 0.9f, 0, 1.3f));
    const glm::vec3 from(0.2f, -0.5f, 0.1f);
    std::vector<glm::vec3> before, beyond;
    for (const glm::vec3 direction : directions_around()) {
        bake::WalkHit hit;
        ASSERT_TRUE(bake::find_hit(body->space, from, direction,
                                   std::numeric_limits<float>::infinity(), hit));
        before.push_back(from + 0.99f * (hit.position - from));
        beyond.push_back(from + 1.01f * (hit.position - from));
    }
    before.push_back(from);
    std::vector<std::uint8_t> seen;
    bake::find_seen(body->space, from, before, seen);
    EXPECT_EQ(seen, std::vector<std::uint8_t>(before.size(), 1));
    bake::find_seen(body->space, from, beyond, seen);
    EXPECT_EQ(seen, std::vector<std::uint8_t>(beyond.size(), 0));
}

}  // namespace
}  // namespace opaline::tests
