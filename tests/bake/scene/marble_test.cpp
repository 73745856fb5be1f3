#include "bake/scene/marble.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace opaline::tests {
namespace {

using bake::marble_color;
using formats::Marble;
using formats::Rgb;

const Marble kGrey = {0.1f, {{0, 0, 0}, {1, 1, 1}}};

std::vector<glm::vec3> places(std::size_t count, float size) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> along(-size, size);
    std::vector<glm::vec3> drawn(count);
    for (glm::vec3& p : drawn) {
        p = {along(random), along(random), along(random)};
    }
    return drawn;
}

TEST(Marble, StaysBetweenItsColoursAndFiniteHoweverFarAway) {
    const Marble marble = {1e-6f, {{0.2f, 0, 1}, {0.5f, 0.3f, 0}, {0.4f, 1, 0.5f}}};
    for (const float size : {1e-30f, 1e-3f, 1.0f, 1e6f, 1e30f, 1.5e38f}) {
        for (const glm::vec3 p : places(200, size)) {
            const Rgb c = marble_color(marble, p);
            ASSERT_TRUE(c.r >= 0.2f && c.r <= 0.5f) << size << " " << c.r;
            ASSERT_TRUE(c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1) << size;
        }
    }
}

// u grows by 1 per `scale` across the veins, plus 2 t, which lies in [0, 4]: it removes at most 4
// veins, and adds some where it turns back.
TEST(Marble, VeinsAreScaleApart) {
    const glm::dvec3 across = glm::normalize(glm::dvec3(0.8, 0.5, 0.6));
    constexpr int kVeins = 500, kSteps = 100;
    int found = 0;
    bool between = false;
    for (int i = 0; i < kVeins * kSteps; ++i) {
        const double way = static_cast<double>(kGrey.scale) * i / kSteps;
        const float c = marble_color(kGrey, glm::vec3(way * across)).r;
        found += between && c < 0.2f ? 1 : 0;
        between = c > 0.5f || (between && c >= 0.2f);
    }
    EXPECT_GE(found, kVeins - 5);
    EXPECT_LE(found, 2 * kVeins);
}

TEST(Marble, ScalesWithItsScale) {
    const Marble larger = {4 * kGrey.scale, kGrey.colors};
    for (const glm::vec3 p : places(500, 1)) {
        // A power of two: both are computed with the same digits.
        EXPECT_FLOAT_EQ(marble_color(kGrey, p).r, marble_color(larger, 4.0f * p).r);
    }
}

// The noise has a gradient of at most 4 a unit, each octave as much as the first: 5 octaves times
// 2 of distortion over features of 2, and 1 of the coordinate, times pi of the sine.
TEST(Marble, IsContinuous) {
    const float step = 1e-3f * kGrey.scale;
    for (const glm::vec3 p : places(2000, 1)) {
        const float a = marble_color(kGrey, p).r,
                    b = marble_color(kGrey, p + glm::vec3(step, 0, 0)).r;
        EXPECT_LT(std::abs(a - b), 0.07f);
    }
}

}  // namespace
}  // namespace opaline::tests
