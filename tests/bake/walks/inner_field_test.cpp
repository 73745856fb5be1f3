#include "bake/effects/multiple/walks/inner_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bake/receivers/surface_samples.h"
#include "tests/bake/walks/body_walks.h"

namespace opaline::tests {
namespace {

struct InnerBody {
    std::unique_ptr<WalkedBody> body;
    std::vector<bake::WalkStart> starts;
    bake::InnerField field;
    bake::ViewFit fit;
};

InnerBody make_inner_body(Primitive shape, float sigma_t, std::uint32_t sites, float g = 0) {
    InnerBody inner;
    inner.body = make_walked_body(std::move(shape), make_forward_medium(sigma_t, 0.9f, g, 1.3f));
    const auto surface = bake::sample_surface(inner.body->scene, {0}, sites, 0, {});
    inner.starts = bake::make_inner_starts(inner.body->space, surface, {});
    inner.field =
        bake::InnerField(inner.starts, 3 / sigma_t, 1 / ((1 - 0.9f * g) * sigma_t), g == 0);
    inner.fit = bake::make_view_fit(1.3);
    return inner;
}

using Light = std::function<double(glm::vec3 position, glm::vec3 direction)>;

// A light at the sites in the rows of a receiver, and what its own flight sees of that light.
struct Weighed {
    std::array<double, 4> rows{}, truth{};
    std::size_t sites = 0;
};

Weighed weigh(const InnerBody& inner, const bake::BodyPoint& point, const Light& light) {
    const bake::ViewSet views = bake::make_view_set(inner.fit, 1.3, point.normal, 4);
    const auto flight = bake::trace_first_flight(inner.body->space, views, point);
    std::vector<bake::InnerWeight> weights;
    inner.field.weigh(inner.body->space, point, views, flight, 4, weights);
    Weighed weighed;
    weighed.sites = weights.size();
    for (std::size_t r = 0; r < 4; ++r) {
        for (const bake::InnerWeight& w : weights) {
            weighed.rows[r] += static_cast<double>(w.row[r][0]) *
                               light(inner.starts[w.site].position, inner.starts[w.site].arrival);
        }
        for (const bake::FlightNode& node : flight) {
            weighed.truth[r] += static_cast<double>(node.weight[0] * views.share[node.view][r]) *
                                light(node.position, node.direction);
        }
    }
    return weighed;
}

bake::BodyPoint point_on_ball(glm::vec3 normal) {
    normal = glm::normalize(normal);
    return {0.99f * normal, normal, 0.985f * normal, 0};
}

TEST(InnerSites, LieInsideWhereLightThatEntersIsScatteredFirst) {
    for (const float sigma_t : {0.2f, 10.0f}) {
        const InnerBody ball = make_inner_body(make_sphere(4), sigma_t, 2000);
        double depth = 0;
        for (const bake::WalkStart& start : ball.starts) {
            ASSERT_LT(glm::length(start.position), 1);
            EXPECT_NEAR(glm::length(start.arrival), 1, 1e-5f);
            EXPECT_LT(glm::dot(start.arrival, start.flat), 0);
            depth += static_cast<double>(1 - glm::length(start.position)) / 2000;
        }
        // A half space: .833 mean free paths deep, the mean cosine inside, less .02 for the ball's
        // curvature. A thin ball: evenly along chords.
        EXPECT_NEAR(depth, sigma_t > 1 ? 0.081 : 0.27, sigma_t > 1 ? 0.002 : 0.04);
    }
}

TEST(InnerField, EvenLightIsWhatTheFlightScattersInEveryRow) {
    for (const float g : {0.0f, 0.7f}) {
        const InnerBody ball = make_inner_body(make_sphere(4), 4, 2000, g);
        const Weighed even =
            weigh(ball, point_on_ball({1, 2, -1}), [](glm::vec3, glm::vec3) { return 1.0; });
        for (std::size_t r = 0; r < 4; ++r) {
            EXPECT_NEAR(even.rows[r], even.truth[r], 1e-5) << r;
        }
        EXPECT_GT(even.truth[0], 0.9);
    }
}

TEST(InnerField, LightThatVariesWithThePlaceIsSeenWhereTheFlightGoes) {
    const InnerBody ball = make_inner_body(make_sphere(4), 4, 4000);
    for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(1, -1, 2)}) {
        // As it decays below the surface of an absorbing body, and along a slope.
        const glm::vec3 up = glm::normalize(normal);
        const Light light = [up](glm::vec3 x, glm::vec3) {
            return std::exp(4 * (static_cast<double>(glm::dot(x, up)) - 1)) +
                   0.5 * static_cast<double>(x.y);
        };
        const bake::BodyPoint point = point_on_ball(normal);
        const Weighed seen = weigh(ball, point, light);
        EXPECT_NEAR(seen.rows[0], seen.truth[0], 0.015);
        // Along the normal: T_0 + (1 - m) n . R.
        double error = seen.rows[0] - seen.truth[0];
        for (int axis = 0; axis < 3; ++axis) {
            const auto r = static_cast<std::size_t>(axis) + 1;
            error += (1 - ball.fit.mean) * static_cast<double>(point.normal[axis]) *
                     (seen.rows[r] - seen.truth[r]);
        }
        EXPECT_NEAR(error, 0, 0.02);
    }
}

// An absorbing body dims it hardly less than a flight comes from everywhere along its way, and few
// sites of the receiver's own surface lie so deep. Fits over the radius alone see .81 and .88.
TEST(InnerField, LightFromBehindIsSeenDeepBelowTheReceiver) {
    constexpr float kPaths = 3;  // in the ball's radius
    const InnerBody ball = make_inner_body(make_sphere(4), kPaths, 12000);
    for (const double decay : {0.75, 0.9}) {
        const Light light = [decay](glm::vec3 x, glm::vec3) {
            return std::exp(-static_cast<double>(kPaths) * decay * (static_cast<double>(x.y) + 1));
        };
        const Weighed seen = weigh(ball, point_on_ball({0, 1, 0}), light);
        // Along the normal, +y: T_0 + (1 - m) n . R.
        const double rest = 1 - ball.fit.mean;
        EXPECT_NEAR((seen.rows[0] + rest * seen.rows[2]) / (seen.truth[0] + rest * seen.truth[2]),
                    1, 0.03)
            << decay;
    }
}

TEST(InnerField, ForwardLightIsSeenAlongTheFlight) {
    const InnerBody ball = make_inner_body(make_sphere(4), 4, 4000, 0.8f);
    const glm::vec3 sun = glm::normalize(glm::vec3(1, 1, 0));
    const Light light = [sun](glm::vec3, glm::vec3 d) {
        return static_cast<double>(1 + glm::dot(sun, d));
    };
    for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(1, 1, 0)}) {
        const Weighed seen = weigh(ball, point_on_ball(normal), light);
        EXPECT_NEAR(seen.rows[0], seen.truth[0], 0.01);
    }
}

// Two slabs of one body, a gap between them.
TEST(InnerField, SitesBeyondAGapDoNotCount) {
    Primitive slabs = make_wide_slab(1), other = make_wide_slab(1);
    const auto first = static_cast<std::uint32_t>(slabs.position.size());
    for (glm::vec3& p : slabs.position) {
        p *= glm::vec3(0.02f, 1, 0.02f);
    }
    for (const glm::vec3 p : other.position) {
        slabs.position.push_back(p * glm::vec3(0.02f, 1, 0.02f) - glm::vec3(0, 1.01f, 0));
    }
    slabs.normal.insert(slabs.normal.end(), other.normal.begin(), other.normal.end());
    for (const std::uint32_t i : other.index) {
        slabs.index.push_back(first + i);
    }
    const InnerBody body = make_inner_body(std::move(slabs), 1, 8000);
    const Light light = [](glm::vec3 x, glm::vec3) { return x.y > -1.005f ? 1.0 : 100.0; };
    const glm::vec3 down(0, -1, 0);
    const Weighed seen = weigh(body, {{0, -1, 0}, down, {0, -0.9999f, 0}, 0}, light);
    EXPECT_GT(seen.sites, 20u);
    EXPECT_NEAR(seen.rows[0], seen.truth[0], 1e-4);
}

TEST(InnerField, FewSitesStandInForMore) {
    for (const std::uint32_t sites : {1u, 3u, 15u}) {
        const InnerBody ball = make_inner_body(make_sphere(3), 50, sites);
        const Weighed even =
            weigh(ball, point_on_ball({0, 0, 1}), [](glm::vec3, glm::vec3) { return 1.0; });
        EXPECT_GT(even.sites, 0u);
        EXPECT_NEAR(even.rows[0], even.truth[0], 1e-4) << sites;
    }
    std::vector<bake::InnerWeight> weights(3);
    const InnerBody ball = make_inner_body(make_sphere(3), 50, 1);
    const bake::BodyPoint point = point_on_ball({0, 0, 1});
    const bake::ViewSet views = bake::make_view_set(ball.fit, 1.3, point.normal, 1);
    const auto flight = bake::trace_first_flight(ball.body->space, views, point);
    bake::InnerField().weigh(ball.body->space, point, views, flight, 1, weights);
    EXPECT_TRUE(weights.empty());
}

}  // namespace
}  // namespace opaline::tests
