// Bodies of an index of 1 so small that light hardly scatters twice: what it does is less than the
// plan's bound, in truth and by diffusion.
#include <gtest/gtest.h>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/reference/reference_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"

namespace opaline::bake {
namespace {

PlanEntry multiple_of(const formats::Scene& scene, const Knobs& knobs = {}) {
    return *find_entry(plan_bake(scene, inspect_scene(scene), knobs), "multiple", 0);
}

// Of albedo 0.9; light crosses its diagonal, 2 sqrt(3), over `depth` mean free paths.
formats::Scene smoke_ball(double depth, float g = 0) {
    const auto sigma = static_cast<float>(depth / (2 * std::sqrt(3.0)));
    return tests::make_translucent_scene({tests::make_sphere(3)},
                                         tests::make_medium(sigma, 0.9f, g, 1));
}

formats::Scene smoke_sheet(double depth, float g = 0) {
    const auto sigma = static_cast<float>(depth / std::sqrt(8.01));
    return tests::make_translucent_scene(tests::make_sheet(0.1f),
                                         tests::make_medium(sigma, 0.9f, g, 1));
}

TEST(SmallBodies, SendOutLessThatScatteredTwiceThanTheirBound) {
    PathOptions paths;
    paths.terms = TermSet::multiple;
    EstimateOptions wanted;
    wanted.samples = 4096;
    for (const double depth : {0.05, 0.5, 2.0, 10.0}) {
        for (const float g : {0.0f, 0.6f}) {
            double seen = 0;  // a thin sheet's paths hardly ever scatter twice, a ball's do
            for (const auto& scene : {smoke_ball(depth, g), smoke_sheet(depth, g)}) {
                const auto fixture = tests::make_fixture(scene, tests::make_white_sky());
                const auto receivers = choose_receivers(fixture->scene, 12, 0, std::nullopt);
                const auto truth = estimate_receivers(fixture->space(paths), receivers, wanted, {});
                double largest = 0, error = 0;
                for (const Moments& m : truth->pixel) {
                    largest = std::max(largest, m.mean.x);
                    error = std::max(error, tests::standard_error(m));
                }
                const formats::Medium& medium = *scene.materials[0].medium;
                const MaterialFacts body = inspect_scene(scene).material[0];
                const double bound = small_body_bound(
                    medium, bands_of(medium)[0],
                    static_cast<double>(glm::length(body.high - body.low)), body.area);
                seen = std::max(seen, largest);
                EXPECT_LE(largest, bound + 4 * error) << depth << " g " << g;
                // The plan takes it where it is less than what diffusion makes of a half space.
                EXPECT_LE(multiple_of(scene).bound, bound);
                if (depth < 0.1) {
                    EXPECT_EQ(multiple_of(scene).bound, bound);
                }
            }
            EXPECT_GT(seen, 0) << depth;
        }
    }
}

TEST(SmallBodies, MultipleScatteringLeftOutIsLessThanItsBound) {
    constexpr double kThin = 0.045, kThicker = 0.055;
    BakeOptions options = tests::small_bake();
    const BakeResult chosen = tests::bake_scene(smoke_ball(kThin), options);
    simulate_all_but_bounces(options);
    const BakeResult all = tests::bake_scene(smoke_ball(kThin), options);
    const PlanEntry& left_out = *find_entry(chosen.plan, "multiple", 0);
    ASSERT_FALSE(left_out.on) << left_out.bound;
    EXPECT_TRUE(find_entry(chosen.plan, "single", 0)->on);
    EXPECT_TRUE(find_entry(all.plan, "multiple", 0)->forced);
    const double difference = tests::largest_difference(chosen.asset, all.asset, "white");
    EXPECT_GT(difference, 0) << "nothing was forced";
    EXPECT_LE(difference, left_out.bound);
    EXPECT_TRUE(multiple_of(smoke_ball(kThicker)).on);
}

// Diffusion sums its profile over the surface, of which folds may have any amount in little room:
// there the bound is the profile's centre times the area. Of profiles that are scaled to the energy
// of a walk, which for forward phase functions is more than any dipole's, somewhat more.
TEST(SmallBodies, ManyFoldsSendOutNoMoreThanTheCentreOfTheProfileAllOverThem) {
    constexpr double kDiagonal = 0.1, kArea = 50;
    for (const auto kind : {formats::Medium::Profile::classic, formats::Medium::Profile::better}) {
        for (const float albedo : {0.1f, 0.5f, 0.99f}) {
            for (const float g : {-0.8f, 0.0f, 0.5f, 0.9f}) {
                formats::Medium medium = tests::make_medium(0.01f, albedo, g, 1);
                medium.profile = kind;
                const MediumProfile profile = make_medium_profile(medium);
                const double bound =
                    small_body_bound(medium, bands_of(medium)[0], kDiagonal, kArea);
                const double sum = profile.eval(0, 0) * kArea;
                EXPECT_GE(bound, (1 - 1e-9) * sum) << albedo << " g " << g;
                if (kind == formats::Medium::Profile::classic) {
                    EXPECT_LE(bound, (1 + 1e-9) * sum) << albedo << " g " << g;
                }
            }
        }
    }
}

// Total reflection may keep light in a body for any number of its diameters.
TEST(SmallBodies, ThatReflectInsideAreTakenForHalfSpaces) {
    auto scene = smoke_ball(0.045);
    EXPECT_LT(multiple_of(scene).bound, 0.002);
    scene.materials[0].medium->eta = 1.3f;
    EXPECT_GT(multiple_of(scene).bound, 0.5);
}

}  // namespace
}  // namespace opaline::bake
