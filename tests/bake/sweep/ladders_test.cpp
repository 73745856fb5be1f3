#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bake/effects/volumes/volume_knobs.h"
#include "bake/lab/sweep/analysis.h"
#include "bake/lab/sweep/ladders.h"
#include "bake/lab/sweep/reference_ladder.h"
#include "formats/opal/cubemap.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

const SweepSubject kOpaque{};
const SweepSubject kMarble{
    {&kSamples, &kSamplesPerPath, &kEpsilon, &kDepthSamples, &kSingleCubemap, &kPhaseTolerance},
    true};
const SweepSubject kFog{{&kSamples, &kSamplesPerPath, &kEpsilon, &kDepthSamples, &kSingleCubemap,
                         &kPhaseTerms, &kPhaseTolerance},
                        true};

std::vector<SweepPoint> make_ladders(const SweepSubject& subject, const BakeOptions& options,
                                     Quality base) {
    return make_ladders(LadderRequest{all_effects(), subject, options}, base);
}

std::vector<SweepPoint> make_truths(const SweepSubject& subject, const BakeOptions& options) {
    return make_truths(LadderRequest{all_effects(), subject, options});
}

std::set<Ladder> ladders_in(const std::vector<SweepPoint>& points) {
    std::set<Ladder> ladders;
    for (const SweepPoint& p : points) {
        for (const Rung& r : p.rungs) {
            ladders.insert(r.ladder);
        }
    }
    return ladders;
}

TEST(Ladders, NoTwoPointsMakeTheSameBake) {
    for (const SweepSubject& subject : {kOpaque, kMarble, kFog}) {
        const auto points = make_ladders(subject, {}, Quality::preview);
        std::set<std::string> labels;
        for (std::size_t a = 0; a < points.size(); ++a) {
            EXPECT_TRUE(labels.insert(points[a].label).second) << points[a].label;
            for (std::size_t b = 0; b < a; ++b) {
                EXPECT_FALSE(same_bake(points[a].knobs, points[b].knobs, subject))
                    << points[a].label << " and " << points[b].label;
            }
        }
    }
}

TEST(Ladders, KnobsOfEffectsThatAreOffAreLeftOut) {
    const auto opaque = ladders_in(make_ladders(kOpaque, {}, Quality::preview));
    for (const KnobSpec* knob : kFog.knobs) {
        EXPECT_FALSE(opaque.contains(ladder_of(*knob))) << knob->name;
    }
    EXPECT_FALSE(opaque.contains(Ladders::exact_rays));
    const auto marble = ladders_in(make_ladders(kMarble, {}, Quality::preview));
    EXPECT_TRUE(marble.contains(ladder_of(kSamples)));
    EXPECT_TRUE(marble.contains(ladder_of(kDepthSamples)));
    EXPECT_FALSE(marble.contains(ladder_of(kPhaseTerms)));
    EXPECT_TRUE(
        ladders_in(make_ladders(kFog, {}, Quality::preview)).contains(ladder_of(kPhaseTerms)));
}

// How many of the knobs that ladders climb differ.
int count_changes(const Knobs& a, const Knobs& b) {
    return (a.cubemap_size != b.cubemap_size) + (a.coefficients != b.coefficients) +
           (a.code_bits != b.code_bits) + (a.exact_rays != b.exact_rays) +
           static_cast<int>(
               std::count_if(kFog.knobs.begin(), kFog.knobs.end(), [&](const KnobSpec* k) {
                   // A cube map that must not be the finer one follows.
                   return !k->at_most_cubemap && a[*k] != b[*k];
               }));
}

TEST(Ladders, OneAtATimeChangesOneKnobOfThePreview) {
    const Knobs base = *resolve_knobs({});
    int found = 0;
    for (const SweepPoint& p : make_ladders(kFog, {}, Quality::preview)) {
        for (const Rung& r : p.rungs) {
            if (r.ladder == Ladders::cubemap || r.ladder == Ladders::coefficients ||
                r.ladder == Ladders::code_bits || r.ladder == Ladders::exact_rays ||
                r.ladder.knob != nullptr) {
                EXPECT_LE(count_changes(p.knobs, base), 1) << p.label;
                ++found;
            }
        }
    }
    EXPECT_GT(found, 30);
}

TEST(Ladders, AllFourPresetsComeFirstAsBakesKnowThem) {
    BakeOptions options;
    options.seed = 7;
    options.effects = {"direct"};
    const auto points = make_ladders(kMarble, options, Quality::draft);
    for (const Quality q :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        const SweepPoint& p = points[static_cast<std::size_t>(q)];
        BakeOptions own = options;
        own.quality = q;
        EXPECT_EQ(p.label, quality_name(q));
        EXPECT_TRUE(same_bake(p.knobs, *resolve_knobs(own), kFog));
        EXPECT_EQ(p.knobs.seed, 7u);
    }
}

TEST(Ladders, EveryModelIsBakedInThreePresets) {
    SweepSubject subject = kMarble;
    subject.knobs.push_back(&kMultipleModel);
    std::set<std::string> labels;
    for (const SweepPoint& p : make_ladders(subject, {}, Quality::preview)) {
        if (p.rungs.front().ladder == ladder_of(kMultipleModel)) {
            labels.insert(p.label);
            EXPECT_EQ(p.knobs[kMultipleModel], p.rungs.front().value) << p.label;
        }
    }
    EXPECT_EQ(labels,
              (std::set<std::string>{"dipole, draft", "dipole, preview", "dipole, production",
                                     "walks, draft", "walks, preview", "walks, production"}));
}

TEST(Ladders, KnobsOfAWayThatThePlanDidNotChooseAreTriedThatWay) {
    PlanEntry often;
    often.name = "volume-multiple";
    often.subject.kind = Subject::Kind::volume;
    often.on = true;
    often.choice = "walks";
    formats::Scene scene;
    const std::vector<PlanEntry> plan{often};
    const SweepSubject subject = sweep_subject(all_effects(), scene, plan, *resolve_knobs({}));
    EXPECT_TRUE(subject.has(kVolumeWalks));
    EXPECT_FALSE(subject.has(kVolumePaths));
    std::set<double> paths;
    for (const SweepPoint& p : make_ladders(subject, {}, Quality::preview)) {
        for (const Rung& r : p.rungs) {
            if (r.ladder == ladder_of(kVolumePaths)) {
                EXPECT_EQ(kVolumeMethodWords[static_cast<std::size_t>(p.knobs[kVolumeMethod])],
                          "path-integration");
                EXPECT_EQ(p.knobs[kVolumePaths], r.value);
                paths.insert(r.value);
            }
        }
    }
    EXPECT_EQ(paths.size(), kVolumePaths.ladder.size());
}

TEST(Ladders, TruthsChooseWhatTheLaddersBaseChose) {
    SweepSubject subject = kMarble;
    subject.knobs.push_back(&kMultipleModel);
    const BakeOptions options;
    for (const SweepPoint& p :
         make_truths(LadderRequest{all_effects(), subject, options, "dipole"})) {
        EXPECT_EQ(kMultipleModel.words[static_cast<std::size_t>(p.knobs[kMultipleModel])], "dipole")
            << p.label;
        EXPECT_THAT(p.label, ::testing::StartsWith("dipole, "));
    }
    for (const SweepPoint& p :
         make_truths(LadderRequest{all_effects(), subject, options, "dipole, walks"})) {
        EXPECT_EQ(p.knobs[kMultipleModel], 0) << "two bodies that differ: left to the bake";
    }
}

TEST(Ladders, EveryPointIsPossible) {
    for (const SweepSubject& subject : {kOpaque, kFog}) {
        auto points = make_ladders(subject, {}, Quality::preview);
        for (const SweepPoint& truth : make_truths(subject, {})) {
            points.push_back(truth);
        }
        for (const SweepPoint& p : points) {
            EXPECT_TRUE(formats::is_valid_cubemap_size(p.knobs.cubemap_size)) << p.label;
            EXPECT_LE(p.knobs[kSingleCubemap], p.knobs.cubemap_size) << p.label;
            EXPECT_TRUE(p.knobs.coefficients == kAllCoefficients ||
                        p.knobs.coefficients < formats::cubemap_texels(p.knobs.cubemap_size))
                << p.label;
            EXPECT_GE(p.knobs.coefficients, 7u) << p.label;
            EXPECT_TRUE(p.knobs.code_bits == 8 || p.knobs.code_bits == 16) << p.label;
            EXPECT_GE(p.knobs[kDepthSamples], 1) << p.label;
            EXPECT_GE(p.knobs[kSamples], 100) << p.label;
        }
    }
}

TEST(Ladders, TruthsGetCheaperOneByOne) {
    const auto work = [](const Knobs& k) {
        return static_cast<double>(k.cubemap_size) * k.cubemap_size * (k.exact_rays ? 100.0 : 1.0) *
               k[kSamples] *
               std::sqrt(static_cast<double>(
                   std::min<std::size_t>(k.coefficients, formats::cubemap_texels(k.cubemap_size))));
    };
    for (const SweepSubject& subject : {kOpaque, kFog}) {
        const auto truths = make_truths(subject, {});
        for (std::size_t i = 1; i < truths.size(); ++i) {
            EXPECT_LT(work(truths[i].knobs), work(truths[i - 1].knobs)) << truths[i].label;
            EXPECT_EQ(truths[i].knobs.code_bits, 16u);
        }
    }
}

TEST(Ladders, KnobsOfMediaTellBakesOfMediaApartAndNoOthers) {
    const Knobs a = *resolve_knobs({});
    Knobs fewer = a, per_path = a, coefficients = a;
    fewer.set(kSamples, 1000);
    fewer.set(kDepthSamples, 1);
    fewer.exact_rays = true;
    per_path.set(kSamplesPerPath, 4 * a[kSamplesPerPath]);
    for (const Knobs& b : {fewer, per_path}) {
        EXPECT_TRUE(same_bake(a, b, kOpaque));
        EXPECT_FALSE(same_bake(a, b, kMarble));
    }
    coefficients.coefficients = 7;
    EXPECT_FALSE(same_bake(a, coefficients, kOpaque));
}

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
