#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/transmission/rules_transmission.h"
#include "bake/effects/transmission/straight_paths.h"
#include "bake/effects/transmission/view_fit.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/transmission/straight_body.h"

namespace opaline::bake {
namespace {

constexpr glm::vec3 kUp{0, 1, 0};

TEST(StraightPaths, AMatchedSlabShowsWhatIsStraightBehindAttenuatedByBeersLaw) {
    const auto slab = tests::make_crossed({tests::make_crossed_slab(2)}, 1, 0.7f);
    for (const glm::vec3 seen : {kUp, glm::normalize(glm::vec3(0.6f, 0.8f, 0))}) {
        const auto exits = tests::look(*slab, {0.1f, -1e-4f, 0.2f}, seen);
        ASSERT_EQ(exits.size(), 1u);
        EXPECT_NEAR(exits[0].weight[0], std::exp(-0.7 * 2 / seen.y), 1e-4);
        EXPECT_NEAR(glm::dot(exits[0].direction, seen), -1, 1e-6);
    }
}

// The share F is reflected at both faces: behind a (1 - F) / (1 - F^2 a^2) is seen, in front a F
// times that, with a = e^(-sigma_t d).
TEST(StraightPaths, AClearSlabIsTheFresnelSeriesOfItsTwoFaces) {
    constexpr double kEta = 1.5, kReflected = 0.04;
    for (const float sigma_t : {0.0f, 0.5f}) {
        const auto slab = tests::make_crossed({tests::make_crossed_slab(1)}, kEta, sigma_t);
        const auto exits = tests::look(*slab, {0.1f, -1e-4f, 0.2f}, kUp);
        double behind = 0, before = 0;
        for (const StraightExit& exit : exits) {
            EXPECT_NEAR(std::abs(exit.direction.y), 1, 1e-6);
            (exit.direction.y < 0 ? behind : before) += double{exit.weight[0]};
        }
        const double a = std::exp(-double{sigma_t});
        const double series = a * (1 - kReflected) / (1 - kReflected * kReflected * a * a);
        EXPECT_NEAR(behind, series, 3e-4);
        EXPECT_NEAR(before, a * kReflected * series, 3e-4);
    }
}

TEST(StraightPaths, APlaneParallelSlabShiftsViewsButDoesNotTurnThem) {
    const auto slab = tests::make_crossed({tests::make_crossed_slab(1)}, 1.5, 0);
    const TransmissionViews views = spread_views(kUp, 1.5, 32, {0.5f, 0});
    for (const glm::vec3 seen : views.seen) {
        const auto exits = tests::look(*slab, {0.1f, -1e-4f, 0.2f}, seen);
        ASSERT_FALSE(exits.empty());
        // Outside, along the surface 1.5 times as far as inside.
        EXPECT_NEAR(exits[0].direction.x, -1.5 * seen.x, 1e-5);
        EXPECT_NEAR(exits[0].direction.z, -1.5 * seen.z, 1e-5);
        EXPECT_LT(exits[0].direction.y, 0);
    }
}

// In a ball every chord is 2 R c' and meets the boundary at the same angle, so a view shows
// a (1 - F) / (1 - a F), a = e^(-2 sigma_t R c').
TEST(StraightPaths, AnAbsorbingBallShowsOnAverageOverViewsWhatQuadratureSays) {
    for (const double eta : {1.0, 1.3, 1.6}) {
        constexpr float kSigma = 0.8f;
        const auto ball = tests::make_crossed({tests::make_sphere(5)}, eta, kSigma);
        double truth = 0, sum = 0;
        const GaussLegendre rule = make_gauss_legendre(64);
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double c = rule.node[i], passed = fresnel_transmittance(c, eta);
            const double a = std::exp(-2 * double{kSigma} * refracted_cosine(c, eta));
            truth += rule.weight[i] * c * passed * a * passed / (1 - a * (1 - passed));
            sum += rule.weight[i] * c * passed;
        }
        truth /= sum;
        const glm::vec3 normal = ball->scene.primitives[0].normal[17];
        const TransmissionViews views = spread_views(normal, eta, 512, {0.5f, 0.3f});
        EXPECT_NEAR(tests::mean_over(*ball, 0.9999f * normal, views) / truth, 1, 0.005) << eta;
    }
}

TEST(StraightPaths, WhatStandsBehindABodyStandsApartFromTheSkyAndWithItMakesOne) {
    const auto floor_below = [] {
        tests::Primitive floor =
            tests::make_quad({-900, -1.5f, -900}, {0, 0, 1800}, {1800, 0, 0}, 1);
        floor.material = 1;
        return floor;
    };
    const auto slab = tests::make_crossed({tests::make_crossed_slab(1), floor_below()}, 1.5, 0);
    StraightLight found;
    const glm::vec3 from{0.1f, -1e-4f, 0.2f};
    follow_straight(slab->body, tests::start_in(*slab, from, from), {&kUp, 1}, found);
    for (const StraightExit& exit : found.exits) {
        EXPECT_GT(exit.direction.y, 0);
    }
    for (const StraightExit& exit : found.blocked) {
        EXPECT_LT(exit.direction.y, 0);
        EXPECT_NEAR(exit.origin.y, -1, 0.01) << "where it leaves";
    }
    EXPECT_NEAR(tests::sum_of(found.exits) + tests::sum_of(found.blocked), 1, 5e-4);
}

TEST(StraightPaths, WhatIsNoMediumEndsThemInsideAndAShellOfTheirOwnDoesNothing) {
    for (const std::uint32_t material : {0u, 1u}) {
        tests::Primitive inner = tests::make_sphere(2, 0.3f);
        inner.material = material;
        const auto ball = tests::make_crossed({tests::make_sphere(3), inner}, 1.4, 0.5f);
        const auto plain = tests::make_crossed({tests::make_sphere(3)}, 1.4, 0.5f);
        const glm::vec3 seen = ball->scene.primitives[0].normal[17];
        const double crossed = tests::sum_of(tests::look(*ball, 0.9999f * seen, seen));
        const double alone = tests::sum_of(tests::look(*plain, 0.9999f * seen, seen));
        EXPECT_NEAR(crossed, material == 0 ? alone : 0, 1e-4) << material;
    }
}

TEST(StraightPaths, ThroughHolesAndPastTrianglesWithoutAreaTheyEndWithNoMoreThanTheirLight) {
    tests::Primitive open = tests::make_sphere(3);
    open.index.resize(open.index.size() / 2);
    tests::Primitive flat = tests::make_sphere(3);
    for (std::uint32_t i = 0; i + 1 < 60; ++i) {
        flat.index.insert(flat.index.end(), {i, i, i + 1, i, i + 1, i});
    }
    for (const double eta : {1.0 / 3, 1.0, 3.0}) {
        const auto holes = tests::make_crossed({open}, eta, 0),
                   slivers = tests::make_crossed({flat}, eta, 0);
        for (const std::size_t v : {3, 17, 40}) {
            const glm::vec3 normal = flat.normal[v];
            for (const glm::vec3 seen : spread_views(normal, eta, 32, {0.5f, 0}).seen) {
                const double through = tests::sum_of(tests::look(*holes, 0.9999f * normal, seen));
                EXPECT_GE(through, 0);
                EXPECT_LE(through, 1.00001);
                EXPECT_NEAR(tests::sum_of(tests::look(*slivers, 0.9999f * normal, seen)), 1, 5e-4);
            }
        }
    }
}

// Index 1: the mean of e^(-x c) under 2 c dc is 2 (1 - (1 + x) e^-x) / x^2.
TEST(StraightShare, OfAMatchedBallIsItsClosedForm) {
    EXPECT_NEAR(straight_share(1, 0), 1, 1e-12);
    for (const double x : {0.1, 1.0, 5.0, 30.0}) {
        EXPECT_NEAR(straight_share(1, x), 2 * (1 - (1 + x) * std::exp(-x)) / (x * x), 1e-9) << x;
    }
}

TEST(StraightShare, IsNoLessThanWhatABallShowsAndLittleMore) {
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        for (const float sigma_t : {0.1f, 1.0f, 3.0f}) {
            const auto ball = tests::make_crossed({tests::make_sphere(5)}, eta, sigma_t);
            const glm::vec3 normal = ball->scene.primitives[0].normal[17];
            const TransmissionViews views = spread_views(normal, eta, 256, {0.5f, 0.3f});
            const double shown = tests::mean_over(*ball, 0.9999f * normal, views);
            const double bound = straight_share(eta, 2 * double{sigma_t});
            // The ball is a polyhedron, its chords up to 0.5 % too short.
            EXPECT_LE(shown, bound * 1.02) << eta << ' ' << sigma_t;
            EXPECT_GE(shown, 0.75 * bound) << eta << ' ' << sigma_t;
        }
    }
}

// Of balls of radius 1 m and of open plates that are asked for an error of 3 %.
TEST(StraightReach, ErrorThatClearBodiesCannotMeetIsSaidBeforeTheBake) {
    const auto fault_of = [](const tests::Primitive& shape, float sigma_t, double target) {
        const tests::Scene scene =
            tests::make_translucent_scene({shape}, tests::make_grey_medium(0, sigma_t));
        const SceneFacts facts = inspect_scene(scene);
        Knobs knobs;
        knobs.error_target = target;
        std::vector<PlanEntry> plan;
        using Rule = std::pair<const char*, PlanEntry (*)(const PlanInput&)>;
        for (const auto& [name, decide] : {Rule{"transmission", decide_transmission},
                                           Rule{"transmission.view", decide_straight_views}}) {
            PlanEntry entry = decide(
                {scene.materials[0], facts.material[0], knobs, kLeastBound, std::span(plan)});
            entry.name = name;
            plan.push_back(std::move(entry));
        }
        std::vector<formats::Diagnostic> warnings;
        warn_of_reach({scene.materials[0], facts.material[0], knobs}, plan.back(), warnings);
        return warnings.empty() ? std::string() : warnings.front().fault;
    };
    const tests::Primitive ball = tests::make_sphere(3),
                           plate = tests::make_quad({}, {1, 0, 0}, {0, 0, -1});
    EXPECT_EQ(fault_of(ball, 0.1f, 0.03).find("--error: 3 % is out of reach"), 0u);
    EXPECT_EQ(fault_of(plate, 0.1f, 0.03).find("--error: 3 % may be out of reach"), 0u);
    EXPECT_EQ(fault_of(ball, 0.1f, 0.3), "");
    EXPECT_EQ(fault_of(ball, 0.1f, 0), "") << "nothing was asked for";
    EXPECT_EQ(fault_of(ball, 20, 0.03), "") << "hardly any light crosses";
}

}  // namespace

}  // namespace opaline::bake
