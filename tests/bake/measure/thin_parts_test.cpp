#include "bake/effects/multiple/thin_parts.h"

#include <gtest/gtest.h>

#include "tests/bake/single/single_support.h"

namespace opaline::bake {
namespace {

double excess_of(tests::Primitive body, float sigma) {
    const auto setup = tests::set_up(tests::make_translucent_scene(
        {std::move(body)}, tests::make_grey_medium(sigma, 0.01f * sigma)));
    const MediumProfile profile = make_medium_profile(*setup.scene.materials[0].medium, 0, {});
    return estimate_thin_excess(profile, setup.rays, setup.points);
}

TEST(ThinParts, BallsExceedByTheTailBeyondTheirDiameter) {
    for (const float sigma : {2.0f, 20.0f}) {
        const auto medium = tests::make_grey_medium(sigma, 0.01f * sigma);
        const MediumProfile profile = make_medium_profile(medium, 0, {});
        // A coarse ball's inward normals leave it a little earlier than after a diameter.
        EXPECT_NEAR(excess_of(tests::make_sphere(3), sigma), profile.tail(0, 2) / profile.total(0),
                    0.01);
    }
}

TEST(ThinParts, DenseBodiesHaveNone) {
    EXPECT_LT(excess_of(tests::make_sphere(3), 1e4f), 1e-3);
}

TEST(ThinParts, OpenBodiesHaveNoFarSide) {
    EXPECT_EQ(excess_of(tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 4), 2), 0);
}

}  // namespace
}  // namespace opaline::bake
