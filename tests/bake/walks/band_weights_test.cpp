#include "bake/effects/multiple/walks/band_weights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

BandsLeaving walk_down(const bake::WalkSpace& space, const bake::WalkStart& start,
                       std::uint32_t walks) {
    return walk_bands(space, start, walks, [](const auto& exit) { return exit.normal.y < 0; });
}

// Thick and thin bodies, extinctions that nearly coincide and that differ by much, a band that does
// not scatter. Light of one side, as a sun's: of a furnace, walks of one band alone know the
// answer.
TEST(BandWeights, BandsThatShareTheirWalksLeaveAsMuchLightAsEachAloneWithNoMoreNoise) {
    constexpr std::uint32_t kWalks = 20000;
    const std::array<std::pair<glm::vec3, glm::vec3>, 5> media{
        {{{6, 8, 9}, {0.01f, 0.1f, 1}},
         {{0.2f, 0.3f, 0.4f}, {0.01f, 0, 0.2f}},
         {{0.05f, 5, 50}, {0, 0.2f, 0.5f}},
         {{3, 0, 4}, {0.1f, 2, 0.1f}},
         {{0.99f, 1, 1.2f}, {0.01f, 9, 0.01f}}}};
    const glm::vec3 up(0, 1, 0);
    const bake::WalkStart start = start_below({0, 1, 0}, up);
    for (const auto& [sigma_s, sigma_a] : media) {
        const auto together =
            make_walked_body(make_sphere(3), make_coloured_medium(sigma_s, sigma_a), false);
        const BandsLeaving shared = walk_down(together->space, start, kWalks);
        for (int b = 0; b < 3; ++b) {
            const auto at = static_cast<std::size_t>(b);
            if (sigma_s[b] == 0) {
                EXPECT_EQ(shared.mean[at], 0);
                continue;
            }
            const auto alone =
                make_walked_body(make_sphere(3), make_grey_medium(sigma_s[b], sigma_a[b], 1.3f));
            const BandsLeaving own = walk_down(alone->space, start, kWalks);
            EXPECT_NEAR(shared.mean[at], own.mean[0],
                        4 * std::hypot(own.error[0], shared.error[at]) + 1e-6)
                << sigma_s[b];
            EXPECT_LT(shared.error[at], 1.2 * own.error[0] + 1e-6) << sigma_s[b];
        }
    }
}

TEST(BandWeights, ThatNearlyCoincideShareTheNoiseOfAllWalks) {
    const auto ball =
        make_walked_body(make_sphere(3), make_coloured_medium({4, 4.2f, 4.4f}, {0.4f, 0.4f, 0.4f}));
    const bake::WalkStart start = start_below({0, 1, 0}, {0, 1, 0});
    const BandsLeaving own = walk_down(ball->space, start, 20000);
    ball->space = bake::make_walk_space(ball->scene, *ball->triangles, 0, false);
    ASSERT_EQ(ball->space.bands.size(), 3u);
    const BandsLeaving shared = walk_down(ball->space, start, 20000);
    for (const double error : shared.error) {
        EXPECT_NEAR(error, own.error[0] / std::sqrt(3.0), 0.1 * own.error[0]);
    }
}

// A band of high albedo beside one that absorbs nearly all: the latter's walks end soon, and what
// they are worth in the former does not grow by that.
TEST(BandWeights, OfABandThatHardlyAbsorbsAreAtMostThoseOfItsOwnWalksWhateverOthersAbsorb) {
    const auto ball =
        make_walked_body(make_sphere(3), make_coloured_medium({0.99f, 1, 1.2f}, {0.01f, 9, 0.01f}));
    const bake::WalkSpace space = bake::make_walk_space(ball->scene, *ball->triangles, 0, false);
    const bake::WalkStart start = start_below({0, 1, 0}, {0, 1, 0});
    std::vector<bake::WalkExit> exits;
    bake::WalkCounts counts;
    for (std::uint32_t w = 0; w < 60000; ++w) {
        bake::WalkRandom random({1, bake::RandomStage::body_walk, 7, w});
        bake::follow_walk(space, {w % 3, {1, 1, 1}}, start, {1}, random, exits, counts);
    }
    ASSERT_GT(exits.size(), 10000u);
    for (const bake::WalkExit& exit : exits) {
        for (const float weight : exit.weight) {
            EXPECT_LE(weight, 1.001f);
        }
    }
}

// No path, however improbable in some band, gives a weight that is no number or above that of one
// walk.
TEST(BandWeights, OfExtinctionsFarApartAreFiniteAndAtMostThatOfOneWalk) {
    const auto ball = make_walked_body(make_sphere(2), make_grey_medium(1, 1));
    for (const glm::vec3 sigma_s :
         {glm::vec3(1e-20f, 1, 1e20f), glm::vec3(1e-38f, 1e37f, 1e4f), glm::vec3(1e-36f, 1, 1.1f),
          glm::vec3(18, 1e-20f, 1), glm::vec3(1, 1.1f, 1.2f)}) {
        for (const float sigma_a : {0.0f, 100.0f}) {
            ball->scene.materials[0].medium = make_coloured_medium(sigma_s, {sigma_a, 0, sigma_a});
            const bake::WalkSpace space =
                bake::make_walk_space(ball->scene, *ball->triangles, 0, false);
            for (std::uint32_t g = 0; g < space.bands.size(); ++g) {
                for (const float depth : {0.0f, 1e-6f, 0.5f, 1.0f, 15.0f}) {
                    for (const int first : {0, 1, 2}) {
                        bake::BandWeights weights(space, {g, {1, 1, 1}});
                        const float length = depth / weights.sigma_t();
                        bool goes_on = first == 0   ? weights.fly(length, true)
                                       : first == 1 ? weights.cross_first(length)
                                                    : weights.collide_first(0.5f * length, length);
                        for (int flight = 0; goes_on && flight < 20; ++flight) {
                            EXPECT_TRUE(weights.left() >= 0 && weights.left() <= 2.001)
                                << weights.left();
                            for (const float value : weights.value()) {
                                EXPECT_TRUE(value >= 0 && value <= 2.001f) << value;
                            }
                            goes_on = weights.fly(length, flight % 3 != 0) && weights.absorb() &&
                                      weights.scale(0.7f) && weights.survives(0);
                        }
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace opaline::tests
