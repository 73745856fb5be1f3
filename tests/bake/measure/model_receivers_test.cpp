#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/surface_probes.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

// Receivers of the first of two plates, the second `gap` [m] below it; a mean free path is 0.1 m.
std::size_t count_chosen_on_plate(float thickness, float gap) {
    tests::Primitive plate = tests::make_cube(4, false), body = plate;
    for (glm::vec3& p : plate.position) {
        p.y = p.y > 0 ? 0.0f : -thickness;
    }
    for (glm::vec3& p : body.position) {
        p = 2.0f * p;
        p.y -= thickness + gap + 2;
    }
    const auto vertices = static_cast<std::uint32_t>(plate.position.size());
    const formats::Scene scene =
        tests::make_translucent_scene({plate, body}, tests::make_grey_medium(10, 0));
    const auto reference = make_reference_scene(scene, 1).value();
    const std::vector<ReferenceReceiver> chosen =
        choose_model_receivers(reference, 2 * vertices, 0);
    return static_cast<std::size_t>(std::count_if(
        chosen.begin(), chosen.end(),
        [&](const ReferenceReceiver& r) { return r.primitive == 0 && r.normal.y > 0.99f; }));
}

TEST(ModelReceivers, LeaveOutAFoldThatLiesOnItsOwnBody) {
    EXPECT_EQ(count_chosen_on_plate(0.002f, 0.002f), 0u);
    EXPECT_GT(count_chosen_on_plate(0.002f, 0.5f), 0u) << "the gap is wide";
    EXPECT_GT(count_chosen_on_plate(0.5f, 0.002f), 0u) << "what lies there scatters";
}

// A ball with one face turned over.
TEST(ModelReceivers, LeaveOutVerticesWhoseTrianglesTurnFarFromTheirNormal) {
    tests::Primitive ball = tests::make_sphere(3);
    const auto count_chosen = [](const tests::Primitive& body) {
        const formats::Scene scene =
            tests::make_translucent_scene({body}, tests::make_grey_medium(10, 0));
        const auto reference = make_reference_scene(scene, 1).value();
        return choose_model_receivers(reference, 1u << 20, 0).size();
    };
    const std::size_t whole = count_chosen(ball);
    EXPECT_EQ(whole, ball.position.size());
    std::swap(ball.index[1], ball.index[2]);
    EXPECT_EQ(count_chosen(ball), whole - 3);
}

TEST(CheckPoints, SeeHalfOfAThinWalledSurfaceFromBehindAndNothingElse) {
    formats::Scene scene = tests::make_scene({});
    scene.materials.resize(2);
    scene.materials[1].sheet = formats::Sheet{};
    constexpr std::uint32_t kPoints = 1000;
    std::vector<CheckPoint> points(2 * kPoints);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        points[i].key = i / 2;
        points[i].material = i % 2;
    }
    turn_thin_walled(scene, points);
    std::array<std::uint32_t, 2> behind{};
    for (const CheckPoint& point : points) {
        behind[point.material] += point.behind ? 1 : 0;
    }
    EXPECT_EQ(behind[0], 0u);
    EXPECT_NEAR(behind[1], kPoints / 2.0, kPoints / 20.0);
}

std::vector<formats::Diagnostic> describe_forward(float g, std::uint32_t terms) {
    auto medium = tests::make_grey_medium(10, 0.1f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
    const auto scene = tests::make_translucent_scene({tests::make_sphere(1)}, medium);
    PlanEntry entry;
    entry.subject.name = "material 'Grey'";
    entry.on = true;
    entry.terms = terms;
    const MaterialFacts unknown;
    Knobs knobs;
    knobs.set(kPhaseTerms, terms);
    std::vector<formats::Diagnostic> warnings;
    all_effects()[Effect::single].rules[1].warn({scene.materials[0], unknown, knobs}, entry,
                                                warnings);
    return warnings;
}

TEST(ShortSeries, StrongForwardScatteringIsSaidToNeedMoreTermsThanThereAre) {
    const auto warnings = describe_forward(0.9f, 25);
    ASSERT_FALSE(warnings.empty());
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("25 terms"));
    EXPECT_THAT(warnings[0].fault, ::testing::HasSubstr("negative"));
    EXPECT_THAT(warnings[0].remedy, ::testing::HasSubstr("--effects multiple"));
}

TEST(ShortSeries, PhaseFunctionsThatTheTermsResolveAreNotMentioned) {
    EXPECT_TRUE(describe_forward(0.3f, 25).empty());
    // Fewer terms than needed are another matter: --phase-terms.
    for (const formats::Diagnostic& other : describe_forward(0.9f, 9)) {
        EXPECT_THAT(other.fault, ::testing::Not(::testing::HasSubstr("narrow")));
    }
}

}  // namespace

}  // namespace opaline::bake
