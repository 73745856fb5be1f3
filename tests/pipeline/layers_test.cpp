// Bodies that contain other media: what the plan says of them, and what files show.

#include <gmock/gmock.h>

#include "bake/check/check_model.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/reference/terms.h"
#include "bake/scene/inspect_scene.h"
#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/effects.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::make_forward_medium;
using tests::make_sphere;
using tests::Part;

// A ball with a core that swallows all light, of the same index: nothing changes more.
std::vector<Part> with_black_core(const formats::Medium& medium, float radius) {
    return {{make_sphere(3), medium},
            {make_sphere(3, radius), tests::make_grey_medium(0, 1e4f, medium.eta)}};
}

// What the core takes from uniform light, by walks that know of it and walks that do not.
tests::Leaving walk_into(std::vector<Part> parts) {
    const auto body = tests::make_nested_body(std::move(parts));
    return tests::walk_from(body->space,
                            tests::start_at(body->space, {0.02f, 2, 0.03f}, {0, -1, 0}), 1, 8000);
}

TEST(Layers, BoundOfTheMediaInsideIsNeverBelowWhatTheyChange) {
    for (const float g : {0.0f, 0.7f, -0.4f}) {
        for (const float eta : {1.0f, 1.5f}) {
            for (const float albedo : {0.5f, 0.9f, 0.99f}) {
                for (const float sigma_t : {4.0f, 20.0f}) {
                    const formats::Medium medium = make_forward_medium(sigma_t, albedo, g, eta);
                    const std::vector<Part> parts = with_black_core(medium, 0.7f);
                    const auto facts = inspect_scene(tests::make_nested_scene(parts)).material[0];
                    const tests::Leaving whole = walk_into({parts[0]}), cored = walk_into(parts);
                    const double change = whole.all - cored.all;
                    EXPECT_LE(change,
                              layer_bound(medium, facts) + 4 * std::hypot(whole.error, cored.error))
                        << g << " " << eta << " " << albedo << " " << sigma_t;
                }
            }
        }
    }
}

TEST(Layers, ShareThatReachesFallsFromOneWithDepthAndIsOneWhereNothingIsAbsorbed) {
    const formats::Medium medium = make_forward_medium(10, 0.9f, 0.3f, 1.3f);
    double last = 1;
    for (const double depth : {0.0, 0.01, 0.1, 0.5, 1.0, 3.0, 100.0, 1e6}) {
        const double share = share_that_reaches(medium, depth);
        EXPECT_TRUE(share >= 0 && share <= last) << depth;
        last = share;
    }
    EXPECT_EQ(share_that_reaches(medium, 0), 1);
    EXPECT_EQ(last, 0);
    EXPECT_EQ(share_that_reaches(make_forward_medium(10, 1, 0.3f, 1.3f), 100), 1);
    EXPECT_NEAR(share_that_reaches(tests::make_grey_medium(0, 2), 1.5), std::exp(-3.0), 1e-9);
}

PlanEntry layers_of(std::vector<Part> parts) {
    const tests::Scene scene = tests::make_nested_scene(std::move(parts));
    const auto plan = plan_bake(scene, inspect_scene(scene), {});
    const PlanEntry* entry = find_entry(plan, "multiple.layers", 0);
    return entry == nullptr ? PlanEntry{} : *entry;
}

// On where light sees the difference, off where it does not: both sides of the bound.
TEST(Layers, RuleIsOnWhereACoreChangesTheLightAndOffWhereItLiesTooDeepOrIsTheSame) {
    const formats::Medium clear = make_forward_medium(6, 0.9f, 0, 1.3f),
                          dense = make_forward_medium(60, 0.8f, 0, 1.3f);
    const std::vector<Part> thin = with_black_core(clear, 0.9f),
                            deep = with_black_core(dense, 0.5f);
    const PlanEntry on = layers_of(thin), off = layers_of(deep);
    EXPECT_TRUE(on.on);
    EXPECT_GT(walk_into({thin[0]}).all - walk_into(thin).all, kLeastBound);
    EXPECT_FALSE(off.on);
    EXPECT_LT(off.bound, kLeastBound);
    EXPECT_THAT(off.reason, HasSubstr("so deep"));
    // The same random numbers: walks that do not reach the core are the same.
    EXPECT_LT(std::abs(walk_into({deep[0]}).all - walk_into(deep).all), kLeastBound);
    const PlanEntry same = layers_of({{make_sphere(3), clear}, {make_sphere(3, 0.9f), clear}});
    EXPECT_FALSE(same.on);
    EXPECT_EQ(same.bound, 0);
    EXPECT_EQ(layers_of({{make_sphere(3), clear}, {make_sphere(3, 1, {4, 0, 0}), dense}}).name, "")
        << "no rule where nothing lies inside";
}

TEST(Layers, AutoWalksAtEveryQualityAndCountsAllOrdersWhereABodyContainsOthers) {
    // So thick that the dipole would do, but for a thin coat.
    const tests::Scene scene = tests::make_nested_scene(
        {{make_sphere(3), make_forward_medium(3000, 0.99f, 0, 1.3f)},
         {make_sphere(3, 0.98f), make_forward_medium(500, 0.9f, 0, 1.3f)}});
    const SceneFacts facts = inspect_scene(scene);
    for (const Quality quality :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        for (const bool separate : {false, true}) {
            BakeOptions options;
            options.quality = quality;
            options.separate_terms = separate;
            const auto plan = plan_bake(scene, facts, *resolve_knobs(options));
            const PlanEntry& model = *find_entry(plan, "multiple.model", 0);
            EXPECT_TRUE(find_entry(plan, "multiple.layers", 0)->on);
            EXPECT_TRUE(model.on && model.all_orders);
            EXPECT_EQ(model.choice, "walks");
            EXPECT_THAT(model.reason, StartsWith("walks: it contains other media"));
            EXPECT_FALSE(find_entry(plan, "single", 0)->on);
            for (const char* effect : {"multiple", "single", "specular"}) {
                const PlanEntry& buried = *find_entry(plan, effect, 1);
                EXPECT_FALSE(buried.on) << effect;
                EXPECT_THAT(buried.reason, HasSubstr("is not seen")) << effect;
            }
        }
    }
}

BakeOptions layered_bake(double walks) {
    BakeOptions options = bake_by(static_cast<double>(MultipleModel::automatic), walks);
    options.effects = {"multiple", "single"};
    options.set(kViewTerms, 4);
    return options;
}

// Rows are linear in the view and noisy: files err by 7 % (white) and 13 % (studio), by up to 5 %
// on average. The coat alone would show 2.4 times the light, or none.
void expect_true_light(std::vector<Part> parts, const char* what) {
    const tests::Scene scene = tests::make_nested_scene(std::move(parts));
    const BakeResult baked = tests::bake_scene(scene, layered_bake(400000));
    EXPECT_EQ(entry_of(baked, "multiple.model").choice, "walks");
    EXPECT_TRUE(baked.warnings.empty()) << what;
    EXPECT_TRUE(tests::all_finite(baked.asset));
    for (const formats::Rgb& c : tests::relight_primitive(baked.asset, "white", 1)) {
        EXPECT_EQ(c.r + c.g + c.b, 0) << "nobody sees the core's own surface";
    }
    ModelCheckOptions wanted;
    wanted.simulated = TermSet::single | TermSet::multiple;
    wanted.noise = 0.05;
    const auto report = check_model(scene, baked.asset.view(), wanted, {}).value();
    EXPECT_GT(report.receivers_checked, 10u);
    for (const char* soft : {"white", "studio"}) {
        const auto light = std::ranges::find(report.by_light, soft, &ModelErrorReport::Part::name);
        ASSERT_NE(light, report.by_light.end()) << soft;
        EXPECT_LT(light->rms_relative, 0.13 + light->noise) << what << ", " << soft;
        EXPECT_LT(std::abs(light->bias), 0.06 + light->noise / 3) << what << ", " << soft;
    }
}

TEST(Layers, FilesOfCoatsOverCoresShowWhatTheMonteCarloReferenceShows) {
    expect_true_light({{make_sphere(3), make_forward_medium(4, 0.95f, 0, 1.3f)},
                       {make_sphere(3, 0.8f), make_forward_medium(20, 0.7f, 0.3f, 1.5f)}},
                      "dark core");
    expect_true_light({{make_sphere(3), tests::make_grey_medium(0, 0.8f, 1.4f)},
                       {make_sphere(3, 0.9f), make_forward_medium(20, 0.98f, 0, 1.4f)}},
                      "varnish");
}

TEST(Layers, DipoleWarnsThatItIgnoresTheMediaInside) {
    const std::vector<Part> parts{{make_sphere(1), make_forward_medium(4, 0.95f, 0, 1.3f)},
                                  {make_sphere(1, 0.7f), make_forward_medium(20, 0.7f, 0, 1.5f)}};
    const auto warnings_of = [](const std::vector<Part>& bodies, double model) {
        std::string all;
        for (const formats::Diagnostic& w :
             tests::bake_scene(tests::make_nested_scene(bodies), bake_by(model, 5000)).warnings) {
            all += w.fault + "\n";
        }
        return all;
    };
    EXPECT_THAT(warnings_of(parts, kDipole), HasSubstr("other media lie inside ('Part 1')"));
    EXPECT_THAT(warnings_of(parts, kWalked), Not(HasSubstr("other media")));
}

}  // namespace
}  // namespace opaline::bake
