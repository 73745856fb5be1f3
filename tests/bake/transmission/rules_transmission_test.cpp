#include "bake/effects/transmission/rules_transmission.h"

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/transmission/view_fit.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/transmission/straight_body.h"

namespace opaline::bake {
namespace {

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
