#include "bake/check/measure_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "bake/check/error_warnings.h"

namespace opaline::bake {
namespace {

const std::array<std::string, 2> kLights{"white", "sun"};

// `points` points of truth 1 that err by `error` under both lights.
EffectCheck check_of(std::string effect, std::size_t points, double error, bool between,
                     std::uint32_t primitive = 0) {
    EffectCheck check;
    check.effect = std::move(effect);
    check.reference = "what is";
    check.between = between;
    for (std::size_t i = 0; i < points; ++i) {
        append_point({primitive, {{{error, error}, 1}, {{error, error}, 1}}, 7}, check);
    }
    return check;
}

TEST(SummariseChecks, StatesBothPlacesAndTheWhole) {
    EffectCheck worst = check_of("direct", 10, 0.4, true, 3);
    append_point({1, {{{0.1, 0.1}, 1}, {{0.1, 0.1}, 1}}, 7}, worst);
    const std::array<EffectCheck, 3> checks{check_of("direct", 20, 0.01, false),
                                            check_of("multiple", 20, 0.02, false), worst};
    const ErrorReport report = summarise_checks(checks, kLights, 0);
    EXPECT_NEAR(report.at_receivers.rms_relative, std::sqrt((1e-4 + 4e-4) / 2), 1e-12);
    EXPECT_NEAR(report.between.rms_relative, std::sqrt((10 * 0.16 + 0.01) / 11), 1e-12);
    EXPECT_NEAR(report.rms_relative, std::sqrt((20 * 5e-4 + 1.61) / 51), 1e-12);
    EXPECT_LT(report.between.ci95[0], report.between.rms_relative);
    EXPECT_NEAR(report.between.ci95[1], 0.4, 1e-9);
    EXPECT_EQ(report.receivers_checked, 40u);
    EXPECT_EQ(report.points_between_checked, 11u);
    EXPECT_EQ(report.worst_between, 3u);
    ASSERT_EQ(report.at_receivers.by_effect.size(), 2u);
    EXPECT_EQ(report.at_receivers.by_effect[1].name, "multiple");
    EXPECT_NEAR(report.at_receivers.by_effect[1].rms_relative, 0.02, 1e-12);
    ASSERT_EQ(report.between.by_effect.size(), 1u);
    ASSERT_EQ(report.by_light.size(), 2u);
    EXPECT_NEAR(report.by_light[1].rms_relative, report.rms_relative, 1e-12);
    EXPECT_EQ(worst.rays, 77u);
}

class MeasuredErrorWarnings : public ::testing::Test {
  protected:
    MeasuredErrorWarnings() {
        scene.primitives.resize(4);
        scene.primitives[3].name = "floor";
    }

    std::vector<formats::Diagnostic> describe(double at_receivers, double between,
                                              bool is_bounded = false) const {
        const std::array<EffectCheck, 2> checks{check_of("direct", 20, at_receivers, false),
                                                check_of("direct", 20, between, true, 3)};
        return describe_measured_error(scene, knobs, summarise_checks(checks, kLights, 0),
                                       is_bounded);
    }

    formats::Scene scene;
    Knobs knobs;
};

TEST_F(MeasuredErrorWarnings, LargeErrorsOfAPresetAreSaidAndSmallOnesAreNot) {
    EXPECT_TRUE(describe(0.09, 0.09).empty());
    const auto vertices = describe(0.11, 0.09);
    ASSERT_EQ(vertices.size(), 1u);
    EXPECT_THAT(vertices[0].fault, ::testing::HasSubstr("at its vertices"));
    EXPECT_THAT(vertices[0].remedy, ::testing::HasSubstr("--coefficients"));
    const auto surface = describe(0.01, 0.3);
    ASSERT_EQ(surface.size(), 1u);
    EXPECT_THAT(surface[0].where, ::testing::HasSubstr("floor"));
    EXPECT_THAT(surface[0].fault, ::testing::HasSubstr("30 %"));
    EXPECT_THAT(surface[0].remedy, ::testing::HasSubstr("more vertices"));
    EXPECT_EQ(describe(0.87, 0.99).size(), 2u);
}

TEST_F(MeasuredErrorWarnings, ALargerLimitOfReceiversIsAdvisedWhereALimitEndedRefinement) {
    knobs.refine.mode = RefineChoice::Mode::where_light_changes;
    const auto limited = ::testing::HasSubstr("--max-receivers");
    EXPECT_THAT(describe(0.01, 0.3, true).at(0).remedy, limited);
    EXPECT_THAT(describe(0.01, 0.3, false).at(0).remedy, ::testing::Not(limited));
}

TEST_F(MeasuredErrorWarnings, DraftsMayErrByTwiceAsMuch) {
    knobs.quality = Quality::draft;
    EXPECT_TRUE(describe(0.19, 0.19).empty());
    EXPECT_EQ(describe(0.21, 0.21).size(), 2u);
}

TEST_F(MeasuredErrorWarnings, WithATargetThePointsBetweenMustMeetItToo) {
    knobs.error_target = 0.02;
    EXPECT_TRUE(describe(0.01, 0.019).empty());
    const auto missed = describe(0.01, 0.03);
    ASSERT_EQ(missed.size(), 1u);
    EXPECT_THAT(missed[0].fault, ::testing::HasSubstr("2 % asked for"));
    // The pilot explains why receivers miss it.
    EXPECT_TRUE(describe(0.5, 0.01).empty());
}

}  // namespace
}  // namespace opaline::bake
