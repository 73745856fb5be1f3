// Which model of multiple scattering a bake takes, and what the plan says of it.

#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "bake/pipeline/unmet_requests.h"
#include "bake/scene/inspect_scene.h"
#include "runtime/terms.h"
#include "tests/support/effects.h"
#include "tests/support/sheets.h"
#include "tests/support/walk_bake.h"

namespace opaline::bake {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kAutomatic = static_cast<double>(MultipleModel::automatic);

// A ball of radius 1; mean chord 4 / 3.
tests::Scene make_ball(float sigma_t, float albedo, float g = 0, float eta = 1.3f) {
    formats::Medium medium = tests::make_grey_medium(albedo * sigma_t, (1 - albedo) * sigma_t, eta);
    if (g != 0) medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
    return tests::make_translucent_scene({tests::make_sphere(2)}, medium);
}

PlanEntry planned_entry(const tests::Scene& scene, const BakeOptions& options, const char* rule) {
    return *find_entry(
        plan_bake(all_effects(), scene, inspect_scene(scene), *resolve_knobs(options)), rule, 0);
}

TEST(ModelChoice, AutoWalksAtProductionWhereTheDipoleWasMeasuredToErr) {
    const auto bake_of = [](float sigma_t) {
        BakeOptions options = bake_by(kAutomatic, 20000);
        options.quality = Quality::production;
        return tests::bake_scene(make_ball(sigma_t, 0.9f), options);
    };
    const PlanEntry thin = entry_of(bake_of(3), "multiple.model");
    EXPECT_TRUE(thin.on);
    EXPECT_THAT(thin.reason, StartsWith("walks: measured at 64 vertices"));
    const PlanEntry thick = entry_of(bake_of(3000), "multiple.model");
    EXPECT_FALSE(thick.on);
    EXPECT_THAT(thick.reason, HasSubstr("dipole"));
}

// Draft and preview measure nothing: the plan already knows.
TEST(ModelChoice, AutoWalksAtDraftAndPreviewWhereTheDipoleIsEstimatedToErrByMore) {
    const auto entries = [](float sigma_t, Quality quality) {
        BakeOptions options = bake_by(kAutomatic, 20000);
        options.quality = quality;
        const tests::Scene ball = make_ball(sigma_t, 0.9f);
        const PlanEntry planned = planned_entry(ball, options, "multiple.model");
        const PlanEntry baked = entry_of(tests::bake_scene(ball, options), "multiple.model");
        EXPECT_EQ(planned.on, baked.on);
        EXPECT_EQ(planned.choice, baked.choice);
        EXPECT_EQ(planned.reason, baked.reason);
        return baked;
    };
    // 4, 53 and 4000 transport mean free paths across.
    EXPECT_THAT(entries(3, Quality::draft).reason, StartsWith("walks: the dipole takes"));
    EXPECT_EQ(entries(40, Quality::draft).choice, "dipole");
    EXPECT_EQ(entries(40, Quality::preview).choice, "walks");
    EXPECT_EQ(entries(3000, Quality::preview).choice, "dipole");
}

// Volume and area of an open mesh say nothing: rays along its normals do.
TEST(ModelChoice, AutoFindsByRaysHowThickAnOpenBodyIs) {
    const auto entry = [](std::vector<tests::Primitive> body, float sigma_t,
                          const char* rule = "multiple.model") {
        const BakeOptions options = bake_by(kAutomatic, 20000);
        return entry_of(
            tests::bake_scene(tests::make_translucent_scene(
                                  std::move(body), tests::make_grey_medium(sigma_t, 0.01f)),
                              options),
            rule);
    };
    tests::Primitive holed = tests::make_sphere(2);
    holed.index.resize(holed.index.size() - 240);  // a quarter
    const PlanEntry thin = entry({holed}, 3), thick = entry({holed}, 3000);
    EXPECT_THAT(entry({holed}, 3, "multiple.view").reason, HasSubstr("measured at 16 vertices"));
    EXPECT_TRUE(thin.on);
    EXPECT_THAT(thin.reason, StartsWith("walks: the body is so thin"));
    EXPECT_FALSE(thick.on);
    EXPECT_THAT(thick.reason, StartsWith("dipole: the body is so thick"));
    EXPECT_LT(thick.model_error, 0.05);
    EXPECT_EQ(entry({holed}, 40).choice, entry({tests::make_sphere(2)}, 40).choice)
        << "a quarter makes no difference";
    EXPECT_FALSE(entry({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4)}, 3).on)
        << "nothing stands behind it: a half space";
}

TEST(ModelChoice, AutoKeepsTheDipoleWhereAMediumNamesItsProfile) {
    formats::Medium medium = tests::make_grey_medium(2.97f, 0.03f);
    medium.profile = formats::Medium::Profile::classic;
    BakeOptions options = bake_by(kAutomatic, 20000);
    for (const Quality quality : {Quality::preview, Quality::production}) {
        options.quality = quality;
        EXPECT_EQ(
            entry_of(tests::bake_scene(
                         tests::make_translucent_scene({tests::make_sphere(2)}, medium), options),
                     "multiple.model")
                .reason,
            "dipole: the medium names its profile");
    }
}

TEST(ModelChoice, LightScatteredOnceIsLeftToWalksThatStandCloseAndToNoOtherModel) {
    const auto effects_on = [](float sigma_t, double model, bool apart = false) {
        const tests::Scene ball = make_ball(sigma_t, 0.99f);
        Knobs knobs;
        knobs.quality = Quality::production;
        knobs.separate_terms = apart;
        knobs.set(kMultipleModel, model);
        knobs.set(kSites, 1500);
        std::vector<std::string> on;
        for (const PlanEntry& entry : plan_bake(all_effects(), ball, inspect_scene(ball), knobs)) {
            if (entry.on && (entry.name == "multiple" || entry.name == "single")) {
                on.emplace_back(entry.name);
            }
        }
        return on;
    };
    const std::vector<std::string> apart{"multiple", "single"}, together{"multiple"};
    EXPECT_EQ(effects_on(3, kWalked), together);
    EXPECT_EQ(effects_on(3, kAutomatic), together);
    EXPECT_EQ(effects_on(3, kDipole), apart);
    EXPECT_EQ(effects_on(300, kWalked), apart) << "1500 sites would blur it";
    EXPECT_EQ(effects_on(3, kWalked, true), apart) << "--separate-terms";
}

// The dipole would leave light scattered once to 25 terms of a peak that needs hundreds: the bunny
// at 500 transport mean free paths, g = .9 and albedo .9 was 97 % off, and the file 20 times
// larger.
TEST(ModelChoice, MediaThatScatterInAPeakAreLeftToWalksHoweverThickTheBody) {
    const auto choice = [](float g, Quality quality, bool fixed = false) {
        tests::Scene ball = make_ball(3000, 0.9f, g);
        if (fixed) ball.materials[0].medium->profile = formats::Medium::Profile::better;
        BakeOptions options = bake_by(kAutomatic, 2000);
        options.quality = quality;
        options.effects = {"multiple", "single"};
        const PlanEntry planned = planned_entry(ball, options, "multiple.model");
        if (quality == Quality::draft) {
            const BakeResult baked = tests::bake_scene(ball, options);
            EXPECT_EQ(entry_of(baked, "multiple.model").choice, planned.choice) << g;
            EXPECT_EQ(entry_of(baked, "multiple.model").model_error, planned.model_error) << g;
            EXPECT_EQ(entry_of(baked, "single").on, planned.choice == "dipole") << g;
        }
        if (planned.choice == "walks") {
            EXPECT_NEAR(planned.model_error, 0.15, 1e-9) << "walks err in a peak as well";
        }
        return std::string(planned.choice);
    };
    EXPECT_EQ(choice(0.9f, Quality::draft), "walks");
    EXPECT_EQ(choice(0.9f, Quality::production), "walks");
    EXPECT_EQ(choice(0.9f, Quality::production, true), "dipole") << "a profile that was chosen";
    EXPECT_EQ(choice(0, Quality::draft), "dipole");
    EXPECT_EQ(choice(0.6f, Quality::production), "dipole") << "25 terms hold it";
}

// One row for all views was marked as multiple scattering alone: `--terms single` showed nothing.
TEST(ModelChoice, ARowThatHoldsLightOfAllOrdersShowsNeitherOfThemAlone) {
    const tests::Scene ball = tests::make_translucent_scene({tests::make_sphere(1)},
                                                            tests::make_grey_medium(2.97f, 0.03f));
    BakeOptions options = bake_by(kWalked, 2000);
    options.quality = Quality::draft;
    const auto shows = [](const BakeResult& bake, TermSet terms) {
        EXPECT_EQ(bake.asset.primitives[0].terms, 1u);
        return runtime::check_terms(bake.asset.view(), terms, "").has_value();
    };
    options.effects = {"multiple", "single"};
    const BakeResult both = tests::bake_scene(ball, options);
    EXPECT_FALSE(shows(both, TermSet::single));
    EXPECT_FALSE(shows(both, TermSet::multiple));
    EXPECT_TRUE(shows(both, TermSet::multiple | TermSet::single));
    options.effects = {"multiple"};
    EXPECT_TRUE(shows(tests::bake_scene(ball, options), TermSet::multiple));
}

// The dipole where it leaves enough of the target, another model where it does not; what the models
// err by is no more to be had for the numbers.
TEST(ModelChoice, ErrorAskedForIsThatOfTheModelAndTheNumbersTogether) {
    const auto bake_of = [](float sigma_t, double error, double model) {
        BakeOptions options = tests::only({"multiple"});
        options.error = error;
        options.set(kMultipleModel, model);
        return tests::bake_scene(make_ball(sigma_t, 0.99f), options);
    };
    const BakeResult thick = bake_of(100, 0.2, kAutomatic);
    const PlanEntry dipole = entry_of(thick, "multiple.model");
    EXPECT_FALSE(dipole.on);
    EXPECT_GT(dipole.model_error, 0.01);
    EXPECT_DOUBLE_EQ(thick.accuracy->model, dipole.model_error);
    EXPECT_NEAR(std::hypot(thick.accuracy->model, thick.accuracy->numerical), 0.2, 1e-9);

    const BakeResult thin = bake_of(3, 0.2, kAutomatic);
    EXPECT_TRUE(entry_of(thin, "multiple.model").on);
    EXPECT_EQ(entry_of(thin, "multiple.model").choice, "walks");
    EXPECT_LT(thin.accuracy->model, 0.05) << "one row for all views";

    const BakeResult forced = bake_of(3, 0.1, kDipole);
    EXPECT_GT(forced.accuracy->model, 0.15) << "measured, because it was asked for";
    EXPECT_FALSE(forced.accuracy->met);
    EXPECT_TRUE(std::ranges::any_of(forced.warnings, [](const formats::Diagnostic& w) {
        return w.fault.find("out of reach: the models err by") != std::string::npos;
    }));
}

// An open body may be a sheet, so walks are expected; this one is thick.
TEST(ModelChoice, LightScatteredOnceIsBackWhereTheDipoleWasMeasuredToServe) {
    tests::Scene ball = make_ball(200, 0.99f, 0.5f);
    auto& index = ball.primitives[0].index;
    index.resize(index.size() / 12 * 9);  // a hole too large to know the thickness
    const auto bake_of = [&](double model) {
        BakeOptions options = tests::only({"multiple", "single"});
        options.error = 0.3;
        options.set(kMultipleModel, model);
        return tests::bake_scene(ball, options);
    };
    const BakeResult chosen = bake_of(kAutomatic);
    const auto first = plan_bake(all_effects(), ball, inspect_scene(ball), chosen.knobs);
    EXPECT_FALSE(find_entry(first, "single", 0)->on);
    EXPECT_TRUE(entry_of(chosen, "single").on);
    EXPECT_THAT(entry_of(chosen, "multiple.model").reason, StartsWith("dipole: measured"));
    EXPECT_EQ(tests::largest_difference(chosen.asset, bake_of(kDipole).asset, "studio"), 0);
}

TEST(ModelChoice, RequestsThatWalksOverruleAreNamed) {
    // Sites too far apart for rows by view.
    const tests::Scene dense = make_ball(300, 0.99f);
    BakeOptions options = bake_by(kWalked, 20000);
    options.set(kViewTerms, 4);
    const auto warnings_of = [](const tests::Scene& scene, const BakeOptions& wanted) {
        const Knobs knobs = *resolve_knobs(wanted);
        const SceneFacts facts = inspect_scene(scene);
        const auto plan = plan_bake(all_effects(), scene, facts, knobs);
        std::string all;
        for (const formats::Diagnostic& w :
             describe_unmet({all_effects(), scene, facts, knobs, plan}, wanted)) {
            all += w.where + ": " + w.fault + "; ";
        }
        return all;
    };
    EXPECT_THAT(warnings_of(dense, options), HasSubstr("--view-terms"));
    const tests::Scene thin = make_ball(3, 0.99f);
    EXPECT_THAT(warnings_of(thin, options), Not(HasSubstr("--view-terms")));
    options.effects = {"multiple", "single"};
    EXPECT_THAT(warnings_of(thin, options), Not(HasSubstr("--effects")))
        << "light scattered once is in the file";
}

TEST(ModelChoice, RowsByViewAreTakenWhereTheBodyIsThinOrAbsorbsAndTheQualityAsks) {
    const auto entry = [](float sigma_t, const BakeOptions& options, float eta = 1.3f,
                          float albedo = 0.999f) {
        return entry_of(tests::bake_scene(make_ball(sigma_t, albedo, 0, eta), options),
                        "multiple.view");
    };
    BakeOptions options = bake_by(kWalked, 20000);
    EXPECT_EQ(entry(100, options, 1.3f, 1).terms, 1u) << "preview";
    EXPECT_EQ(entry(3, options).terms, 4u) << "one row was measured to err by 7 %";
    options.quality = Quality::production;
    EXPECT_EQ(entry(1, options).terms, 4u);
    EXPECT_EQ(entry(100, options, 1.3f, 1).terms, 1u);
    EXPECT_EQ(entry(10, options, 1).terms, 4u) << "views are farther apart inside";
    EXPECT_EQ(entry(10, options, 1.3f, 0.9f).terms, 4u) << "light from deep inside is missing";
    EXPECT_EQ(entry(3000, options).terms, 1u);
    BakeOptions apart = options;
    apart.separate_terms = true;
    EXPECT_THAT(entry(3, apart).reason, HasSubstr("--separate-terms"));
}

// RMS over the views that enter, at index 1 with density 2 c. The plan takes the lesser of plates
// and balls.
TEST(ModelChoice, NineRowsByViewAreTakenWhereTheyMakeTheDifferenceThatThePlanSays) {
    struct Said {
        std::uint32_t terms = 0;
        double error = 0, difference = 0;
    };
    const auto said = [](float albedo, double around) {
        const tests::Scene block = tests::make_translucent_scene(
            {tests::make_plate(1, 6, 1.5f)},
            tests::make_grey_medium(40 * albedo, 40 * (1 - albedo), 1));
        BakeOptions options = bake_by(kWalked, 500000);
        options.set(kSites, 12000);
        options.set(kWalksAround, around);
        options.effects = {"multiple", "single"};
        options.quality = Quality::production;
        // Of the middle of the upper face, by the cosine of the view.
        constexpr std::array<float, 5> kCosines{0.1f, 0.3f, 0.5f, 0.7f, 0.9f};
        const auto seen = [&](double views) {
            BakeOptions wanted = options;
            wanted.set(kViewTerms, views);
            const BakeResult baked = tests::bake_scene(block, wanted);
            std::array<double, kCosines.size()> sums{};
            for (std::size_t i = 0; i < sums.size(); ++i) {
                const float c = kCosines[i];
                runtime::ShadeOptions from;
                from.eye = formats::Vec3{1e4f * std::sqrt(1 - c * c), 1e4f * c, 0};
                const std::vector<formats::Rgb> radiance =
                    tests::relight_primitive(baked.asset, "white", 0, from);
                for (std::size_t v = 0; v < radiance.size(); ++v) {
                    const formats::Vec3 at = baked.asset.position[v];
                    const bool inner =
                        at.y == 0.5f && std::max(std::abs(at.x), std::abs(at.z)) < 0.6f;
                    sums[i] += inner ? static_cast<double>(radiance[v].g) : 0;
                }
            }
            return sums;
        };
        BakeOptions four = options;
        four.set(kViewTerms, 4);
        const auto with_four = seen(4), with_nine = seen(9);
        double squares = 0, truth = 0, all = 0;
        for (std::size_t i = 0; i < kCosines.size(); ++i) {
            const double share = static_cast<double>(kCosines[i]);
            squares += share * std::pow(with_nine[i] - with_four[i], 2);
            truth += share * with_nine[i];
            all += share;
        }
        return Said{planned_entry(block, options, "multiple.view").terms,
                    planned_entry(block, four, "multiple.view").model_error,
                    std::sqrt(squares / all) / (truth / all)};
    };
    const Said dark = said(0.5f, 300), bright = said(0.9f, 100);
    EXPECT_EQ(dark.terms, 9u);
    EXPECT_GT(dark.difference, 0.8 * dark.error);
    EXPECT_LT(dark.difference, 2 * dark.error);
    EXPECT_EQ(bright.terms, 4u);
    EXPECT_LT(bright.error, 0.03);
    EXPECT_LT(bright.difference, 0.03);
}

TEST(ModelChoice, MoreRowsByViewAreTakenWhereFlatBodiesAbsorbOrAreThin) {
    const auto rows = [](std::vector<tests::Primitive> body, float sigma_t, float albedo, float eta,
                         float g, Quality quality) {
        tests::Scene scene = make_ball(sigma_t, albedo, g, eta);
        scene.primitives = std::move(body);
        BakeOptions options = bake_by(kWalked, 20000);
        options.set(kSites, 100000);
        options.set(kWalksAround, 1);
        options.quality = quality;
        return planned_entry(scene, options, "multiple.view").terms;
    };
    const std::vector<tests::Primitive> plate{tests::make_plate(0.05f)};
    const std::vector<tests::Primitive> ball{tests::make_sphere(2)};
    constexpr Quality kBest = Quality::production;
    EXPECT_EQ(rows(plate, 20, 0.99f, 1, 0, kBest), 9u) << "one mean free path";
    EXPECT_EQ(rows(plate, 100, 0.99f, 1, 0, kBest), 4u) << "five";
    EXPECT_EQ(rows(plate, 100, 0.5f, 1, 0, kBest), 9u) << "half of what arrives is absorbed";
    EXPECT_EQ(rows(plate, 100, 0.5f, 1, 0, Quality::preview), 4u);
    EXPECT_EQ(rows(plate, 100, 0.5f, 1.5f, 0, kBest), 4u) << "views inside lie close";
    EXPECT_EQ(rows(ball, 5, 0.5f, 1, 0, kBest), 4u) << "its edge is bright and then dark";
    EXPECT_EQ(rows(ball, 30, 0.5f, 1, 0.9f, kBest), 9u) << "a forward peak";
    EXPECT_EQ(rows(ball, 30, 0.5f, 1.3f, 0.9f, kBest), 4u) << "nine did not help";
    EXPECT_EQ(rows(tests::make_sheet(0.05f), 100, 0.99f, 1, 0, kBest), 9u)
        << "open: how thick it is, is not known";
}

}  // namespace
}  // namespace opaline::bake
