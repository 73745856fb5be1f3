#include "bake/lab/sweep/reference_ladder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/lab/sweep/analysis.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

// No clock decides: there is time for all.
ReferenceLadder climb(const formats::Scene& scene) {
    ReferenceLadderOptions options;
    options.seconds = 1e9;
    options.most_samples = 1024;
    auto ladder = climb_reference(scene, options, {});
    EXPECT_TRUE(ladder && *ladder);
    return ladder && *ladder ? std::move(**ladder) : ReferenceLadder{};
}

double rate(const ReferenceLadder& ladder) {
    std::vector<Convergence> rungs;
    for (const ReferenceRung& rung : ladder.rungs) {
        rungs.push_back({static_cast<double>(rung.samples), rung.error, rung.seconds});
    }
    const auto fit = fit_slope(rungs, false);
    EXPECT_TRUE(fit && fit->saturated.empty());
    return fit ? fit->slope : 0;
}

formats::Scene ball_on_a_floor() {
    return tests::make_scene({tests::make_sphere(2, 1, {0, 1.1f, 0}),
                              tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 8)});
}

formats::Scene milky_ball() {
    return tests::make_translucent_scene({tests::make_sphere(2)},
                                         tests::make_grey_medium(4, 0.05f));
}

TEST(ReferenceLadder, ErrorFallsWithTheRootOfTheSamplesAsTheStoredVarianceSays) {
    for (const formats::Scene& scene : {ball_on_a_floor(), milky_ball()}) {
        const ReferenceLadder ladder = climb(scene);
        ASSERT_EQ(ladder.rungs.size(), 5u);
        EXPECT_EQ(ladder.rungs.back().samples, 1024u);
        EXPECT_NEAR(rate(ladder), -0.5, 0.05);
        for (const ReferenceRung& rung : ladder.rungs) {
            // 160 receivers or more; the truth's noise is half the last rung's variance. Few
            // samples state the error of independent ones.
            const bool is_few = rung.samples < Moments::kFewGroups * RandomStream::kGroup;
            EXPECT_LT(rung.error, 1.25 * rung.stated) << rung.samples;
            EXPECT_GT(rung.error, (is_few ? 0.5 : 0.75) * rung.stated) << rung.samples;
        }
    }
}

TEST(ReferenceLadder, TruthsOwnNoiseIsSubtracted) {
    // One receiver: mean 1.5 against 1, of variance .09 and .16.
    std::vector<Moments> rung(1), truth(1);
    rung[0] = {2, glm::dvec3(1.5), glm::dvec3(0.18)};
    truth[0] = {2, glm::dvec3(1), glm::dvec3(0.32)};
    const ReferenceRung found = compare_rung(rung, truth);
    EXPECT_NEAR(found.error, std::sqrt((0.25 - 0.16) / (1 - 0.16)), 1e-12);
    EXPECT_NEAR(found.stated, 0.3 / std::sqrt(1 - 0.16), 1e-12);
}

TEST(ReferenceLadder, WithoutTimeThereAreTwoRungsOfFewReceiversAndWithoutLightNone) {
    ReferenceLadderOptions hurried;
    hurried.seconds = 0;
    const auto two = climb_reference(milky_ball(), hurried, {}).value();
    EXPECT_EQ(two->rungs.size(), 2u);
    EXPECT_EQ(two->receivers, 16u) << "nor more receivers than it takes";
    hurried.most_seconds = 0;
    EXPECT_FALSE(climb_reference(milky_ball(), hurried, {}).value());
    formats::Scene black = ball_on_a_floor();
    black.materials[0].base_color = {0, 0, 0};
    ReferenceLadderOptions few;
    few.most_samples = 16;
    EXPECT_FALSE(climb_reference(black, few, {}).value());
}

}  // namespace
}  // namespace opaline::bake
