#include "bake/effects/multiple/walks/first_flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/physics/fresnel.h"
#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

using bake::FlightNode;

struct Straight {
    std::array<double, 3> scattered{};  // of each group
    double depth = 0;                   // mean, of the first group
};

// Along the normal, from the top of a slab.
Straight look_down(const bake::WalkSpace& space) {
    const glm::vec3 up(0, 1, 0);
    const auto eta = static_cast<double>(space.eta);
    const bake::ViewSet views = bake::make_view_set(bake::make_view_fit(eta), eta, up, 4);
    const auto flight = bake::trace_first_flight(space, views, {{}, up, {0, -1e-5f, 0}, 0});
    Straight seen;
    for (const FlightNode& node : flight) {
        if (node.view + 1 == views.into.size()) {
            for (std::size_t g = 0; g < 3; ++g) {
                seen.scattered[g] += static_cast<double>(node.weight[g]);
            }
            seen.depth += static_cast<double>(node.weight[0] * -node.position.y);
        }
    }
    seen.depth /= seen.scattered[0];
    return seen;
}

// Light that is reflected inside again and again: (1 - T) (1 + r T + ...), T = e^-x.
TEST(FirstFlight, SlabScattersWhatDoesNotCrossItHoweverOftenItIsReflected) {
    for (const float eta : {1.0f, 1.8f}) {
        for (const float thickness : {0.05f, 1.0f, 5.0f}) {
            const auto slab =
                make_walked_body(make_wide_slab(thickness), make_forward_medium(1, 0.9f, 0, eta));
            const double crosses = std::exp(-static_cast<double>(thickness));
            const double reflects = bake::fresnel_reflectance(1, 1 / static_cast<double>(eta));
            EXPECT_NEAR(look_down(slab->space).scattered[0],
                        (1 - crosses) / (1 - reflects * crosses), 1e-3)
                << eta << ' ' << thickness;
        }
    }
}

// Mean depth of first scatterings in a slab: 1 - x / (e^x - 1) mean free paths.
TEST(FirstFlight, DepthsAreThoseOfAnExponential) {
    for (const float thickness : {0.05f, 1.0f, 5.0f}) {
        const auto slab =
            make_walked_body(make_wide_slab(thickness), make_forward_medium(1, 0.9f, 0, 1));
        const double truth =
            1 - static_cast<double>(thickness) / std::expm1(static_cast<double>(thickness));
        EXPECT_NEAR(look_down(slab->space).depth / truth, 1, 5e-3) << thickness;  // four depths
    }
}

TEST(FirstFlight, EachGroupOfBandsHasItsOwnExtinction) {
    formats::Medium medium = make_grey_medium(0.9f, 0.1f, 1);
    medium.sigma_s = {0.9f, 1.9f, 3.9f};
    const auto slab = make_walked_body(make_wide_slab(1), medium, false);
    ASSERT_EQ(slab->space.bands.size(), 3u);
    const Straight seen = look_down(slab->space);
    for (std::size_t g = 0; g < 3; ++g) {
        EXPECT_NEAR(seen.scattered[g],
                    -std::expm1(-static_cast<double>(slab->space.media[0].sigma_t[g])), 1e-4);
    }
}

// Half of the views from an edge leave through the other face after next to no way. They would be
// black: files of cubes had dark lines along their edges.
TEST(FirstFlight, ViewsFromASharpEdgeSeeAsMuchAsOthers) {
    const auto cube = make_walked_body(make_cube(2, false), make_forward_medium(20, 1, 0, 1));
    const glm::vec3 up(0, 1, 0);
    const bake::ViewSet views = bake::make_view_set(bake::make_view_fit(1), 1, up, 1);
    const auto seen_from = [&](glm::vec3 place, bool fills_crossed = false) {
        double sum = 0;
        for (const FlightNode& node : bake::trace_first_flight(
                 cube->space, views, {place, up, 0.99999f * place, 0}, fills_crossed)) {
            sum += static_cast<double>(node.weight[0] * views.share[node.view][0]);
        }
        return sum;
    };
    EXPECT_NEAR(seen_from({1, 1, 0}), 1, 1e-3) << "a vertex";
    EXPECT_NEAR(seen_from({1, 1, 1}), 1, 1e-3);
    EXPECT_NEAR(seen_from({1, 1, 0.3f}), 0.5, 0.06) << "none: its views are those of the solid";
    EXPECT_NEAR(seen_from({1, 1, 0.3f}, true), 1, 1e-4) << "nothing else holds what crosses";
    EXPECT_NEAR(seen_from({0, 1, 0}), 1, 1e-3);
}

// A body that stands in its floor is lit by what scatters above it.
TEST(FirstFlight, WhatStandsInABodyTakesOnlyTheLightThatReachesIt) {
    Primitive floor = make_wide_slab(5);
    for (glm::vec3& p : floor.position) {
        p.y -= 2;  // from y = -2 down
    }
    floor.material = 1;
    const auto slab = make_walked_scene(make_translucent_scene(
        {make_wide_slab(5), std::move(floor)}, make_forward_medium(1, 0.9f, 0, 1.4f)));
    EXPECT_NEAR(look_down(slab->space).scattered[0], -std::expm1(-2.0), 1e-3);
}

// A floor far below an open body is none that stands in it: through the hole light is lost as
// without.
TEST(FirstFlight, WhatLiesFarBeyondAHoleTakesNoMoreThanNothing) {
    const auto seen_above = [](bool has_floor) {
        Primitive body = make_wide_slab(1);
        const std::vector<std::uint32_t> all = std::exchange(body.index, {});
        for (std::size_t i = 0; i < all.size(); i += 3) {
            const auto is_low = [&](std::size_t k) { return body.position[all[i + k]].y < -0.5f; };
            if (is_low(0) && is_low(1) && is_low(2)) continue;  // the bottom is open
            body.index.insert(body.index.end(), {all[i], all[i + 1], all[i + 2]});
        }
        std::vector<Primitive> parts{std::move(body)};
        if (has_floor) {
            parts.push_back(make_wide_slab(1));
            parts.back().material = 1;
            for (glm::vec3& p : parts.back().position) {
                p.y -= 300;
            }
        }
        return look_down(
            make_walked_scene(
                make_translucent_scene(std::move(parts), make_forward_medium(1, 0.9f, 0, 1)))
                ->space);
    };
    const Straight without = seen_above(false), with = seen_above(true);
    EXPECT_NEAR(with.scattered[0], without.scattered[0], 1e-5);
    EXPECT_NEAR(with.depth, without.depth, 1e-5);
}

// Through a hole flights go on to the box; what is left there the others make up for.
TEST(FirstFlight, HoleOfABallLosesNoLight) {
    Primitive ball = make_sphere(3);
    for (std::size_t i = ball.index.size() / 2; i < ball.index.size() / 2 + 3 * 12; ++i) {
        ball.index[i] = 0;  // of no area
    }
    const auto whole = make_walked_body(make_sphere(3), make_forward_medium(0.5f, 0.9f, 0, 1.3f));
    const auto holed = make_walked_body(std::move(ball), make_forward_medium(0.5f, 0.9f, 0, 1.3f));
    const bake::ViewFit fit = bake::make_view_fit(1.3);
    const auto scattered = [&](const bake::WalkSpace& space) {
        double sum = 0;
        constexpr std::size_t kPoints = 40;
        const Primitive& points = whole->scene.primitives[0];
        for (std::size_t i = 0; i < kPoints; ++i) {
            const glm::vec3 normal = points.normal[7 * i];
            const bake::ViewSet views = bake::make_view_set(fit, 1.3, normal, 1);
            const glm::vec3 position = points.position[7 * i];
            for (const FlightNode& node :
                 bake::trace_first_flight(space, views, {position, normal, 0.999f * position, 0})) {
                sum += static_cast<double>(node.weight[0] * views.share[node.view][0]) / kPoints;
            }
        }
        return sum;
    };
    EXPECT_NEAR(scattered(holed->space) / scattered(whole->space), 1, 0.01);
}

}  // namespace
}  // namespace opaline::tests
