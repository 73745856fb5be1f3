#include "bake/effects/multiple/walks/ball_bank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/scene/triangle.h"
#include "tests/bake/walks/nested_bodies.h"

namespace opaline::tests {
namespace {

bake::PhaseTable make_phase(formats::PhaseFunction::Type type, float g) {
    formats::PhaseFunction phase;
    phase.type = type;
    phase.g = g;
    return bake::make_phase_table(phase);
}

bake::PhaseTable henyey_greenstein(float g) {
    return make_phase(formats::PhaseFunction::Type::henyey_greenstein, g);
}

bake::BallBank make_bank(const bake::PhaseTable& phase, double largest, unsigned threads = 0) {
    bake::Context context;
    context.threads = threads;
    return bake::make_ball_bank(phase, {.largest = largest, .events = 1e9, .seed = 3}, context);
}

// Means over all records of the radius that is the largest within `radius`.
struct BallMeans {
    double scatterings = 0, length = 0, straight = 0;
    double variance = 0;           // of scatterings less length
    double along = 0, leaves = 0;  // the way and the last direction along the first flight
    double outward = 0;            // the way times the last direction
    double radius = 0;
};

BallMeans means_of(const bake::BallBank& bank, float radius) {
    constexpr std::size_t kRecords = bake::BallBank::kRecords;
    const glm::vec3 axis(0.48f, -0.6f, 0.64f);
    BallMeans means;
    for (std::size_t i = 0; i < kRecords; ++i) {
        const auto u = (static_cast<float>(i) + 0.5f) / static_cast<float>(kRecords);
        const bake::BallJump jump = bank.draw(radius, axis, u, 0.37f);
        const auto n = static_cast<double>(jump.scatterings),
                   length = static_cast<double>(jump.length);
        means.radius = static_cast<double>(glm::length(jump.way));
        means.scatterings += n / kRecords;
        means.length += length / kRecords;
        means.variance += (n - length) * (n - length) / kRecords;
        means.straight += n == 0 ? 1.0 / kRecords : 0;
        means.along += static_cast<double>(glm::dot(jump.way, axis)) / kRecords;
        means.leaves += static_cast<double>(glm::dot(jump.direction, axis)) / kRecords;
        means.outward += static_cast<double>(glm::dot(jump.way, jump.direction)) / kRecords;
    }
    return means;
}

// Along a walk of unit extinction x . w + w . w0 / (1 - g), N - L, (N - L)^2 - L and
// |x|^2 + 2 (x . w - L) / (1 - g) keep their means: w turns by a factor g on average at every
// scattering, x moves by w, and scatterings are a Poisson process in the length L. So their means
// at the exit are those at the start, whatever the phase function.
void expect_conserved_moments(const BallMeans& means, double g, double times) {
    const double r = means.radius, few = times / std::sqrt(double{bake::BallBank::kRecords});
    EXPECT_NEAR(means.straight, std::exp(-r), few * std::sqrt(std::exp(-r)));
    EXPECT_NEAR(means.along + means.leaves / (1 - g), 1 / (1 - g), few * (r + 1 / (1 - g)))
        << g << " " << r;
    const double expected = 0.5 * (1 - g) * (r * r + 2 * means.outward / (1 - g));
    EXPECT_NEAR(means.length / expected, 1, few) << g << " " << r;
    EXPECT_NEAR(means.scatterings, means.length, few * std::sqrt(means.length));
    EXPECT_NEAR(means.variance / means.length, 1, 0.1) << g << " " << r;
}

TEST(BallBank, MomentsOfExitsAreThoseThatTransportConserves) {
    const std::array<std::pair<bake::PhaseTable, double>, 5> phases{
        {{make_phase(formats::PhaseFunction::Type::isotropic, 0), 0.0},
         {henyey_greenstein(-0.5f), -0.5},
         {henyey_greenstein(0.5f), 0.5},
         {henyey_greenstein(0.9f), 0.9},
         {make_phase(formats::PhaseFunction::Type::rayleigh, 0), 0.0}}};
    for (const auto& [phase, g] : phases) {
        const bake::BallBank bank = make_bank(phase, 10);
        EXPECT_EQ(bank.radii(), 9u);
        for (const float wanted : {1.5f, 4.0f, 9.6f}) {
            const BallMeans means = means_of(bank, wanted);
            EXPECT_LE(means.radius, static_cast<double>(wanted) * (1 + 1e-6));
            EXPECT_GT(means.radius, static_cast<double>(wanted) / 1.27);
            expect_conserved_moments(means, g, 4);
        }
    }
}

// Walks of balls that are too large to be followed event by event jump through smaller ones.
TEST(BallBank, BallsMadeOfSmallerOnesConserveTheSameMoments) {
    for (const double g : {-0.99, 0.0, 0.9, 0.99}) {
        const bake::BallBank bank =
            bake::make_ball_bank(henyey_greenstein(static_cast<float>(g)),
                                 {.largest = 800, .events = 6e5, .jumps = 1e8, .seed = 3}, {});
        ASSERT_EQ(bank.radii(), 28u) << g;
        for (const float wanted : {20.0f, 100.0f, 768.0f}) {
            expect_conserved_moments(means_of(bank, wanted), g, 4);
        }
    }
}

// Each radius has walks of r^2 / 2 scatterings and more, of which larger radii jump most.
TEST(BallBank, HasNoRadiiWhoseWalksWouldHaveMoreEventsThanAllowed) {
    const bake::PhaseTable phase = make_phase(formats::PhaseFunction::Type::isotropic, 0);
    const auto radii = [&](double events, double jumps) {
        return bake::make_ball_bank(phase, {.largest = 1e6, .events = events, .jumps = jumps}, {})
            .radii();
    };
    EXPECT_EQ(radii(1, 1e9), 0u);
    const std::size_t some = radii(1e6, 0);
    EXPECT_GT(some, 2u);
    EXPECT_LT(bake::BallBank::kRecords * 0.5 * std::pow(1.5 * std::exp2((some - 1.0) / 3), 2), 1e6);
    EXPECT_EQ(radii(1e6, 1), some + 1);
    EXPECT_EQ(make_bank(phase, 1.4).radii(), 0u);
}

// What leaves by walks that cross balls and by those that follow every event.
struct BothLeave {
    Leaving plain, jumping;
};

BothLeave leave_both_ways(WalkedBody& body, const bake::WalkStart& start, std::uint32_t walks) {
    BothLeave both;
    both.plain = walk_from(body.space, start, 1, walks);
    bake::add_balls(body.space, 1e6, 5, {});
    both.jumping = walk_from(body.space, start, 1, walks);
    EXPECT_EQ(both.plain.counts.jumps, 0u);
    EXPECT_GT(both.jumping.counts.jumps, walks / 10);
    EXPECT_LT(both.jumping.counts.events, both.plain.counts.events);
    EXPECT_EQ(both.jumping.counts.lost + both.jumping.counts.endless, 0u);
    return both;
}

void expect_alike(const BothLeave& both, const char* what) {
    const double error = std::hypot(both.plain.error, both.jumping.error);
    EXPECT_NEAR(both.jumping.all, both.plain.all, 4 * error) << what;
    EXPECT_NEAR(both.jumping.below, both.plain.below, 4 * error) << what;
    EXPECT_LT(both.jumping.error, 1.15 * both.plain.error) << what;
}

TEST(BallWalk, LeavesDenseBodiesAsWalksWithoutBallsDo) {
    for (const float g : {-0.5f, 0.0f, 0.9f}) {
        const auto medium =
            make_forward_medium(std::max(70.0f, 60 / (1 - g)), 1 - 0.01f * (1 - g), g, 1.3f);
        const auto ball = make_walked_body(make_sphere(3), medium);
        expect_alike(leave_both_ways(*ball, start_below({0, 0.995f, 0}, {0, 1, 0}), 6000), "ball");
    }
    // So flat that a cell of the grid is thicker.
    const auto slab = make_walked_body(make_wide_slab(12), make_forward_medium(1, 0.99f, 0, 1.4f));
    const BothLeave both = leave_both_ways(*slab, start_below({0, 0, 0}, {0, 1, 0}), 20000);
    expect_alike(both, "slab");
}

// Events of walks that follow each grow with the depth: 8 000 and 80 000 in the mean.
TEST(BallWalk, TakesFewMoreStepsInABodyTenTimesAsDeep) {
    for (const float g : {-0.99f, 0.99f}) {
        for (const float depth : {1e3f, 1e4f}) {
            const auto box =
                make_walked_body(make_cube(1, false), make_forward_medium(depth, 1, g, 1.5f));
            bake::add_balls(box->space, 1e5, 5, {});
            constexpr std::uint32_t kWalks = 300;
            const Leaving leaving =
                walk_from(box->space, start_below({0.1f, 0.5f, 0.2f}, {0, 1, 0}), 1, kWalks);
            EXPECT_EQ(leaving.counts.endless, 0u) << g << " " << depth;
            EXPECT_LT(leaving.counts.events, kWalks * 800u) << g << " " << depth;
            EXPECT_NEAR(leaving.all, 1, 4 * leaving.error) << g << " " << depth;
        }
    }
}

// Bands that fly differently, one that is not scattered in the core, through a coat and a core.
TEST(BallWalk, BandsThatShareWalksThroughMediaInEachOtherLeaveAsWithoutBalls) {
    formats::Medium coat = make_forward_medium(1, 1, 0.4f, 1.3f),
                    core = make_forward_medium(1, 1, 0.4f, 1.5f);
    coat.sigma_s = {80, 70, 120};
    coat.sigma_a = {0.4f, 0.1f, 0.2f};
    core.sigma_s = {90, 0, 60};
    core.sigma_a = {0.2f, 3, 0.1f};
    const auto body =
        make_nested_body({{make_sphere(3), coat}, {make_sphere(3, 0.7f), core}}, false);
    ASSERT_EQ(body->space.bands.size(), 3u);
    const bake::WalkStart start = start_at(body->space, {0.02f, 2, 0.03f}, {0, -1, 0});
    constexpr std::uint32_t kWalks = 4000;
    struct Sums {
        std::array<double, 3> mean{}, square{};
        double drift = 0, turned = 0;  // of the second band: what lobes are told
        bake::WalkCounts counts;
    };
    const auto sum_up = [&] {
        Sums sums;
        sums.counts = visit_walks(body->space, start, {1}, kWalks, [&](const auto& exits) {
            std::array<double, 3> own{};
            for (const bake::WalkExit& exit : exits) {
                for (std::size_t b = 0; b < 3; ++b) {
                    own[b] += static_cast<double>(exit.weight[b]);
                }
                const auto weight = static_cast<double>(exit.weight[1]) / kWalks;
                sums.drift += weight * static_cast<double>(glm::length(exit.drift));
                sums.turned += weight * std::log(1 + static_cast<double>(exit.turned));
            }
            for (std::size_t b = 0; b < 3; ++b) {
                sums.mean[b] += own[b] / kWalks;
                sums.square[b] += own[b] * own[b] / kWalks;
            }
        });
        return sums;
    };
    const Sums plain = sum_up();
    bake::add_balls(body->space, 1e6, 5, {});
    const Sums jumping = sum_up();
    EXPECT_GT(jumping.counts.jumps, kWalks);
    for (std::size_t b = 0; b < 3; ++b) {
        const double variance = plain.square[b] - plain.mean[b] * plain.mean[b],
                     of_jumping = jumping.square[b] - jumping.mean[b] * jumping.mean[b];
        EXPECT_NEAR(jumping.mean[b], plain.mean[b],
                    4 * std::sqrt((variance + of_jumping) / kWalks));
        EXPECT_LT(of_jumping, 1.3 * variance);
    }
    EXPECT_NEAR(jumping.drift / plain.drift, 1, 0.06);
    EXPECT_NEAR(jumping.turned / plain.turned, 1, 0.06);
}

// Where light hardly goes on, balls save no time, and few walks none that banks cost.
TEST(BallWalk, FewWalksAndMediaThatAbsorbMuchHaveNoBalls) {
    const auto has_balls = [](float albedo, double walks) {
        const auto ball = make_walked_body(make_sphere(2), make_forward_medium(70, albedo, 0, 1));
        bake::add_balls(ball->space, walks, 5, {});
        return ball->space.balls.front() != nullptr;
    };
    EXPECT_TRUE(has_balls(0.99f, 1e6));
    EXPECT_FALSE(has_balls(0.9f, 1e6));
    EXPECT_FALSE(has_balls(0.99f, 1000));
}

TEST(FindClearance, IsTheDistanceToTheNearestOfAllTriangles) {
    const auto body = make_walked_body(make_sphere(2), make_forward_medium(1, 1, 0, 1));
    const Primitive& p = body->scene.primitives[0];
    bake::WalkRandom random({4, bake::RandomStage::body_walk, 0, 0});
    for (int i = 0; i < 200; ++i) {
        const float x = random.next(), y = random.next();
        const glm::vec3 point = 1.4f * glm::vec3(x, y, random.next()) - 0.7f;
        double nearest = HUGE_VAL;
        for (std::size_t t = 0; t + 2 < p.index.size(); t += 3) {
            const auto to = [&](std::size_t k) {
                return glm::dvec3(p.position[p.index[t + k]]) - glm::dvec3(point);
            };
            nearest = std::min(nearest, bake::distance_to_triangle(to(0), to(1), to(2)));
        }
        const auto found = static_cast<double>(bake::find_clearance(body->space, point, 3));
        EXPECT_LE(found, nearest);
        EXPECT_NEAR(found, nearest, 1e-5);
        EXPECT_LE(bake::find_clearance(body->space, point, 0.1f), 0.1f);
    }
}

}  // namespace
}  // namespace opaline::tests
