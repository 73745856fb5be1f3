// Furnaces, thin and black bodies, holes and shells: walks where a body is no slab.

#include "bake/effects/multiple/walks/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/multiple/walks/find_hit.h"
#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

TEST(Walk, FurnaceOfAlbedoOneLosesNothingAtAnyIndexAndMeanCosine) {
    for (const float eta : {0.5f, 0.8f, 1.0f, 1.3f, 1.5f, 2.5f}) {
        for (const float g : {-0.9f, 0.0f, 0.9f}) {
            // So dense that what leaves unscattered, 1/2 (sigma_t R)^-2 of the light, does not
            // show.
            const float sigma_t = g > 0 ? 200 : 30;
            const auto ball =
                make_walked_body(make_sphere(3), make_forward_medium(sigma_t, 1, g, eta));
            const Leaving leaving =
                walk_from(ball->space, start_below({0, 0.995f, 0}, {0, 1, 0}), 1, 1500);
            EXPECT_NEAR(leaving.all, 1, 4 * leaving.error + 0.002) << eta << " " << g;
            EXPECT_LT(leaving.counts.lost + leaving.counts.endless, 8u) << eta << " " << g;
        }
    }
}

// In a body much thinner than a mean free path, light that is counted is in proportion to its size.
TEST(Walk, ThinBodiesScatterInProportionToTheirOpticalDepth) {
    const auto of = [](float sigma_t) {
        const auto ball = make_walked_body(make_sphere(3), make_forward_medium(sigma_t, 1, 0, 1));
        return walk_from(ball->space, start_below({0, 0.995f, 0}, {0, 1, 0}), 1, 40000);
    };
    // Mean chord of cosine-distributed starts: 4/3 R.
    for (const float sigma_t : {1e-4f, 1e-3f, 1e-2f}) {
        const Leaving leaving = of(sigma_t);
        const double depth = 4.0 / 3 * static_cast<double>(sigma_t);
        EXPECT_NEAR(leaving.all / depth, 1, 0.03) << sigma_t;
        EXPECT_LT(leaving.error, 0.01 * leaving.all) << sigma_t;
    }
}

TEST(Walk, BlackMediumReturnsNothing) {
    const auto ball = make_walked_body(make_sphere(2), make_grey_medium(0, 5));
    EXPECT_TRUE(ball->space.bands.empty());
}

// Half of the ball's top is missing: what leaves through the hole is counted and made up for.
TEST(Walk, LightLostThroughAHoleIsCountedAndReplacedByTheMeanOfTheRest) {
    const auto body = make_walked_body(make_open_ball(), make_forward_medium(2, 1, 0, 1.3f));
    const Leaving leaving =
        walk_from(body->space, start_below({0, 0.995f, 0}, {0, 1, 0}), 1, 20000);
    EXPECT_GT(leaving.counts.lost, 100u);
    const auto closed = make_walked_body(make_sphere(3), make_forward_medium(2, 1, 0, 1.3f));
    const Leaving whole =
        walk_from(closed->space, start_below({0, 0.995f, 0}, {0, 1, 0}), 1, 20000);
    EXPECT_LT(leaving.all, whole.all - 0.02);
    EXPECT_NEAR(leaving.all * leaving.counts.correction(), whole.all, 0.02);
}

// Upward from the ball at the origin a line enters the ball above through a hole and leaves it: two
// shells by that line, and walks that begin so would leave the body unseen.
TEST(Walk, LineThroughAHoleOfAnotherPartIsOutvotedByOthers) {
    Primitive above = make_open_ball();
    for (glm::vec3& p : above.position) {
        p.y += 3;
    }
    const auto body =
        make_walked_scene(make_translucent_scene({make_sphere(3), above}, make_grey_medium(10, 0)));
    bake::WalkHit hit;
    ASSERT_TRUE(find_hit(body->space, {0, 1.01f, 0}, {0, 1, 0}, 10, hit));
    ASSERT_GT(hit.position.y, 3.5f) << "there is no hole";
    EXPECT_EQ(bake::count_shells(body->space, {0, 0.9f, 0}, {0, 1, 0}), 1);
    EXPECT_EQ(bake::count_shells(body->space, {0, 3, 0}, {0, 1, 0}), 1);
}

// A walk goes through a shell of its own medium inside the body; another material ends it.
TEST(Walk, InnerShellsOfTheSameMediumAreNoBoundaryAndOthersAre) {
    const formats::Medium medium = make_forward_medium(10, 1, 0, 1.3f);
    const auto walked = [&](std::vector<Primitive> parts) {
        return make_walked_scene(make_translucent_scene(std::move(parts), medium));
    };
    const bake::WalkStart start = start_below({0, 0.995f, 0}, {0, 1, 0});
    const auto shells = walked({make_sphere(3), make_sphere(3, 0.7f)});
    const Leaving inside = walk_from(shells->space, start, 1, 4000);
    EXPECT_NEAR(inside.all, 1, 4 * inside.error + 0.002);
    Primitive core = make_sphere(3, 0.9f);
    core.material = 1;
    const auto opaque = walked({make_sphere(3), core});
    EXPECT_LT(walk_from(opaque->space, start, 1, 4000).all, 0.9);
    EXPECT_EQ(bake::count_shells(shells->space, {0, 0, 0}, {0, 1, 0}), 2);
    EXPECT_EQ(bake::count_shells(shells->space, {0, 0.8f, 0}, {0, 1, 0}), 1);
    EXPECT_EQ(bake::count_shells(shells->space, {0, 2, 0}, {0, 1, 0}), 0);
}

}  // namespace
}  // namespace opaline::tests
