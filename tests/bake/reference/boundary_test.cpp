#include "bake/reference/rough_boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace opaline::bake {
namespace {

glm::vec3 in_plane(float degrees) {
    const float angle = glm::radians(degrees);
    return {std::sin(angle), std::cos(angle), 0};
}

constexpr glm::vec3 kFlat{0, 1, 0};

// An interpolated normal that leans toward the viewer reflects below the triangle from some angle
// on.
TEST(SmoothBoundary, AsTheNormalLeansTheRaysTurnWithoutAJump) {
    for (const float ratio : {1.5f, 1 / 1.5f}) {
        for (const float incidence : {30.0f, 60.0f, 80.0f, 89.0f}) {
            const glm::vec3 direction = -in_plane(incidence);
            BoundarySplit before =
                split_at_smooth_boundary(direction, in_plane(-89.9f), kFlat, ratio);
            constexpr float kStep = 0.05f;
            for (float lean = -89.9f; lean < 89.9f; lean += kStep) {
                const BoundarySplit split =
                    split_at_smooth_boundary(direction, in_plane(lean), kFlat, ratio);
                // A reflected ray turns by twice the normal's angle.
                EXPECT_LT(glm::distance(split.reflected, before.reflected),
                          2.2f * glm::radians(kStep))
                    << ratio << ' ' << incidence << ' ' << lean;
                before = split;
            }
        }
    }
}

TEST(SmoothBoundary, RaysNeverLeaveToTheWrongSideOfTheTriangle) {
    for (const float ratio : {0.4f, 1 / 1.5f, 1.0f, 1.33f, 2.4f}) {
        for (float incidence = 0; incidence < 89.9f; incidence += 3.7f) {
            for (float lean = -170; lean < 170; lean += 2.3f) {
                const BoundarySplit split =
                    split_at_smooth_boundary(-in_plane(incidence), in_plane(lean), kFlat, ratio);
                EXPECT_GT(split.reflected.y, 0) << ratio << ' ' << incidence << ' ' << lean;
                EXPECT_NEAR(glm::length(split.reflected), 1, 1e-5f);
                if (split.reflectance < 1) {
                    EXPECT_LT(split.transmitted.y, 0) << ratio << ' ' << incidence << ' ' << lean;
                    EXPECT_NEAR(glm::length(split.transmitted), 1, 1e-5f);
                }
            }
        }
    }
}

TEST(SmoothBoundary, ANormalThatFitsIsTakenAsItIs) {
    const glm::vec3 direction = -in_plane(40), smooth = in_plane(12);
    const BoundarySplit split = split_at_smooth_boundary(direction, smooth, kFlat, 1.5f);
    const BoundarySplit expected = split_at_boundary(direction, smooth, 1.5f);
    EXPECT_EQ(split.reflected, expected.reflected);
    EXPECT_EQ(split.transmitted, expected.transmitted);
    EXPECT_EQ(split.reflectance, expected.reflectance);
}

}  // namespace
}  // namespace opaline::bake
