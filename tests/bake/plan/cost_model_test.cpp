#include "bake/pipeline/cost_model.h"
#include "bake/scene/inspect_scene.h"

#include <gtest/gtest.h>

#include <functional>

#include "bake/effects/multiple/multiple_stage.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

formats::Medium forward_medium() {
    formats::Medium medium = tests::make_grey_medium(40, 1);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = 0.6f;
    return medium;
}

// A ball of a medium over an opaque floor.
formats::Scene ball_on_floor(int levels = 2, std::uint32_t cells = 8) {
    formats::Primitive floor = tests::make_quad({-3, -1.02f, -3}, {0, 0, 6}, {6, 0, 0}, cells);
    floor.material = 1;
    return tests::make_translucent_scene({tests::make_sphere(levels), floor}, forward_medium());
}

struct Predicted {
    std::vector<PlanEntry> plan;
    CostPrediction cost;
};

Predicted predict(const formats::Scene& scene, const Knobs& knobs = {}, unsigned threads = 2,
                  const StageRates& rates = {}) {
    Predicted predicted;
    const SceneFacts facts = inspect_scene(scene);
    predicted.plan = plan_bake(scene, facts, knobs);
    predicted.cost = predict_costs(scene, facts, knobs, rates, threads, predicted.plan);
    return predicted;
}

TEST(CostModel, TotalIsTheSumOfStagesAndOfEffectsAndTheRest) {
    for (const double error : {0.0, 0.02}) {
        Knobs knobs;
        knobs.error_target = error;
        const Predicted p = predict(ball_on_floor(), knobs);
        double stages = 0, entries = p.cost.shared_seconds;
        std::uint64_t bytes = p.cost.shared_bytes;
        for (const StageCost& stage : p.cost.stages) {
            stages += stage.seconds;
        }
        for (const PlanEntry& entry : p.plan) {
            entries += entry.predicted_seconds;
            bytes += entry.predicted_bytes;
            // What these cost is the whole effects' own.
            const bool is_how = entry.name == "light.visibility" ||
                                entry.name == "multiple.spread" || entry.name == "multiple.model";
            EXPECT_EQ(entry.on && !is_how, entry.predicted_seconds > 0)
                << entry.name << entry.subject.name;
        }
        EXPECT_GT(p.cost.shared_seconds, 0);
        EXPECT_NEAR(stages, p.cost.seconds, 1e-9 * p.cost.seconds);
        EXPECT_NEAR(entries, p.cost.seconds, 1e-9 * p.cost.seconds);
        EXPECT_EQ(bytes, p.cost.bytes);
    }
}

// Light maps of a medium show all its bodies, and are drawn once for the receivers of all of them
// that fit into a batch (effects/rows/shared_batches): 16 balls cost some 16 times as much as one,
// but for rays, which are dearer among more triangles.
TEST(CostModel, BodiesOfAMediumShareTheLightMapsOfSingleScattering) {
    const auto seconds_of_single = [](int balls) {
        std::vector<formats::Primitive> primitives;
        for (int i = 0; i < balls; ++i) {
            primitives.push_back(tests::make_sphere(4, 1, {3.0f * static_cast<float>(i), 0, 0}));
        }
        Knobs knobs;
        knobs.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
        const Predicted p =
            predict(tests::make_translucent_scene(std::move(primitives), forward_medium()), knobs);
        const double seconds = find_entry(p.plan, "single", 0)->predicted_seconds;
        EXPECT_GT(seconds, 0);
        return seconds;
    };
    EXPECT_LT(seconds_of_single(16), 2.0 * 16 * seconds_of_single(1));
}

TEST(CostModel, TermsBeyondTheFirstPayForTheirRows) {
    Knobs knobs;
    knobs.set(kPhaseTerms, 9);
    knobs.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
    const Predicted p = predict(ball_on_floor(), knobs);
    const auto entry = [&](const char* effect) { return *find_entry(p.plan, effect, 0); };
    // The first row is that of multiple scattering too, which pays for it.
    EXPECT_NEAR(static_cast<double>(entry("single.terms").predicted_bytes),
                8.0 * static_cast<double>(entry("multiple").predicted_bytes), 8);
    EXPECT_EQ(entry("single").predicted_bytes, 0u);
    EXPECT_GT(entry("single.terms").predicted_seconds, 0);
    EXPECT_GT(entry("single").predicted_seconds, 0);
}

TEST(CostModel, LocalRowsInColourPayForTheTransform) {
    formats::Medium dense = tests::make_grey_medium(1e6f, 1e3f);
    dense.sigma_s.r = 5e5f;
    const auto scene = tests::make_translucent_scene({tests::make_cube(4, false)}, dense);
    Knobs knobs;
    const Predicted p = predict(scene, knobs, 1);
    const auto layouts = layout_rows(scene, p.plan, knobs);
    ASSERT_TRUE(layouts[0].at_entry);
    ASSERT_EQ(layouts[0].bands(), 3u);
    const auto vertices = static_cast<double>(scene.primitives[0].position.size());
    double rows = 0;
    for (const StageCost& stage : p.cost.stages) {
        rows += stage.name.starts_with("rows of ") ? stage.seconds : 0;
    }
    const CostInput input{knobs};
    EXPECT_NEAR(rows,
                encode_work(input, 3, 1, vertices).shared +
                    irradiance_work(input, vertices, layouts[0].occluded).shared,
                1e-9 * rows);
}

// The pilot gathers them once, before it takes samples of media, and tries all encodings on them.
TEST(CostModel, OpaqueReceiversOfThePilotPayInItsFirstStageAlone) {
    Knobs knobs;
    knobs.error_target = 0.05;
    std::vector<double> pilot;
    for (const StageCost& stage :
         predict(tests::make_scene({tests::make_sphere(3)}), knobs).cost.stages) {
        if (stage.name == "pilot") {
            pilot.push_back(stage.seconds);
        }
    }
    ASSERT_EQ(pilot.size(), 2u);
    EXPECT_GT(pilot[0], 0);
    EXPECT_EQ(pilot[1], 0);
}

TEST(CostModel, EffectsThatAreOffCostNothingAndLeaveNoStage) {
    formats::Scene scene = ball_on_floor();
    Knobs knobs;
    knobs.effects = {"direct"};
    scene.materials[0].medium.reset();
    const Predicted p = predict(scene, knobs);
    for (const StageCost& stage : p.cost.stages) {
        for (const char* medium : {"samples", "light maps", "openness"}) {
            EXPECT_EQ(stage.name.find(medium), std::string::npos) << stage.name;
        }
        EXPECT_EQ(stage.name == "bodies" || stage.name == "profiles", stage.seconds == 0)
            << stage.name;
    }
}

// Each larger job: no stage of it may be predicted to take less time, and all of them more.
void expect_dearer(const Predicted& small, const Predicted& large, const char* what) {
    ASSERT_EQ(small.cost.stages.size(), large.cost.stages.size()) << what;
    for (std::size_t i = 0; i < small.cost.stages.size(); ++i) {
        EXPECT_LE(small.cost.stages[i].seconds, large.cost.stages[i].seconds)
            << what << ": " << small.cost.stages[i].name;
    }
    EXPECT_LT(small.cost.seconds, large.cost.seconds) << what;
}

TEST(CostModel, MoreReceiversAndTrianglesAreNeverCheaper) {
    expect_dearer(predict(ball_on_floor(2)), predict(ball_on_floor(3)), "finer ball");
    expect_dearer(predict(ball_on_floor(3)), predict(ball_on_floor(4)), "finest ball");
    // Fewer than those from which on receivers share rays (interreflection: sites) or may go
    // (--simplify). Of the receivers of the self-check, a fixed number, fewer lie on the ball,
    // whose truth takes long.
    Predicted few = predict(ball_on_floor(2, 4)), many = predict(ball_on_floor(2, 44));
    for (Predicted* p : {&few, &many}) {
        std::erase_if(p->cost.stages,
                      [](const StageCost& stage) { return stage.name == "self-check"; });
    }
    expect_dearer(few, many, "finer floor");
}

TEST(CostModel, FinerKnobsAreNeverCheaper) {
    const formats::Scene scene = ball_on_floor(3);
    const auto with = [&](const std::function<void(Knobs&)>& change) {
        Knobs knobs;
        // Walks have no knobs of single scattering.
        knobs.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
        change(knobs);
        return predict(scene, knobs);
    };
    const Predicted base = with([](Knobs&) {});
    expect_dearer(base, with([](Knobs& k) { k.cubemap_size = 64; }), "texels");
    expect_dearer(base, with([](Knobs& k) { k.coefficients = 512; }), "coefficients");
    expect_dearer(base, with([](Knobs& k) { k.set(kSingleCubemap, 32); }), "texels of light maps");
    expect_dearer(base, with([](Knobs& k) { k.set(kDepthSamples, 12); }), "depth samples");
    expect_dearer(base, with([](Knobs& k) { k.set(kEpsilon, 1e-4); }), "tolerance");
    expect_dearer(with([](Knobs& k) { k.set(kPhaseTerms, 4); }),
                  with([](Knobs& k) { k.set(kPhaseTerms, 16); }), "terms");
    const auto sampled = [&](std::uint32_t samples) {
        return with([samples](Knobs& k) {
            k.set(kSamples, samples);
            k.given.push_back(&kSamples);
        });
    };
    expect_dearer(sampled(20000), sampled(80000), "samples");
}

TEST(CostModel, ThreadsShareAllButWhatOneMustDo) {
    const double one = predict(ball_on_floor(), {}, 1).cost.seconds;
    const double two = predict(ball_on_floor(), {}, 2).cost.seconds;
    const double many = predict(ball_on_floor(), {}, 1000).cost.seconds;
    EXPECT_LT(two, one);
    EXPECT_GT(two, one / 2);
    EXPECT_LT(many, two);
    EXPECT_GT(many, 0);
}

// A kind that took twice as long takes all others, which no bake had, along.
TEST(CostModel, SlowerMachineTakesLongerForEverything) {
    const StageRates slow{{{"rows", {2, 1}}}};
    const Predicted fast = predict(ball_on_floor()), late = predict(ball_on_floor(), {}, 2, slow);
    for (std::size_t i = 0; i < fast.cost.stages.size(); ++i) {
        EXPECT_NEAR(late.cost.stages[i].seconds, 2 * fast.cost.stages[i].seconds,
                    1e-9 * late.cost.seconds);
        EXPECT_EQ(late.cost.stages[i].work, fast.cost.stages[i].work);
    }
}

// Rows of a medium teach nothing of rows of the floor, but another body's rows of its effects do.
TEST(CostModel, StagesAreOfAKindWhereTheSameEffectsAct) {
    const auto kinds = [](const formats::Scene& scene) {
        std::vector<std::string> rows;
        for (const StageCost& stage : predict(scene).cost.stages) {
            if (stage.name.starts_with("rows of ")) {
                rows.push_back(stage.kind);
            }
        }
        return rows;
    };
    const auto coarse = kinds(ball_on_floor(2)), fine = kinds(ball_on_floor(3));
    ASSERT_EQ(coarse.size(), 2u);
    EXPECT_NE(coarse[0], coarse[1]);
    EXPECT_EQ(coarse, fine);
}

// Shares of nothing are nothing, with a pilot too.
TEST(CostModel, EmptySceneCostsNothing) {
    for (const double error : {0.0, 0.02}) {
        Knobs knobs;
        knobs.error_target = error;
        for (const formats::Scene& scene :
             {tests::make_scene({}), tests::make_translucent_scene({}, forward_medium())}) {
            const Predicted p = predict(scene, knobs, 1);
            EXPECT_EQ(p.cost.receivers, 0u);
            EXPECT_EQ(p.cost.seconds, 0);
            EXPECT_EQ(p.cost.bytes, 0u);
        }
    }
}

TEST(CostBySize, GrowsWithTheDepthOfTheHierarchyAndNeverFalls) {
    const CostBySize cost{3, 5};
    EXPECT_DOUBLE_EQ(cost.at(CostBySize::kFew), 3);
    EXPECT_DOUBLE_EQ(cost.at(CostBySize::kMany), 5);
    EXPECT_DOUBLE_EQ(cost.at(std::sqrt(CostBySize::kFew * CostBySize::kMany)), 4);
    EXPECT_GT(cost.at(1), 0);
    EXPECT_GT(cost.at(0), 0);
    // A measurement that says otherwise is noise.
    EXPECT_DOUBLE_EQ((CostBySize{3, 2}).at(1e6), 3);
}

}  // namespace
}  // namespace opaline::bake
