// What neighbours on a floor drop of their rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/effects/rows/gather_rows.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/exchange/other_light.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/bake/single/single_support.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kFloorSide = 8, kCells = 32, kPoints = kCells + 1;

// A floor with things that stand on it; the floor's vertices are those of a square grid.
formats::Scene set_floor() {
    formats::Primitive ball = tests::make_sphere(2, 0.5f, {0.4f, 0.5f, 0.3f});
    formats::Primitive high = tests::make_sphere(2, 0.4f, {-1.2f, 1.1f, -0.7f});
    return tests::make_scene(
        {tests::make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, kCells), ball, high});
}

// Texel values of the floor's rows: a vertex's radiance under a sun that fills the texel.
std::vector<std::vector<float>> bake_floor(const formats::Scene& scene, std::uint32_t kept,
                                           std::size_t& details) {
    Knobs knobs;
    knobs.cubemap_size = kFloorSide;
    knobs.coefficients = kept;
    knobs.effects = {"direct"};
    const SceneFacts facts = inspect_scene(scene);
    const auto rays = RayScene::build(scene, 1), sky = RayScene::build({}, 1);
    const std::vector<Receiver> outside = make_vertex_receivers(scene);
    const std::vector<BodyPoint> inside = make_body_points(scene, outside);
    const std::vector<ReceiverSet> sets = make_vertex_sets(scene, outside, inside);
    const BakeInputs bake{all_effects(), scene, facts, *rays, *sky, sets};
    std::vector<SubjectState> subjects =
        begin_subjects(bake, plan_bake(scene, facts, knobs), knobs);
    StageLog log;
    const Context context;
    run_step(Step::prepare, bake, knobs, context, subjects, log);
    const RowEncoder encoder = make_row_encoder(kFloorSide, kept, 8);
    std::uint64_t traced = 0;
    const formats::SparseRows rows =
        gather_rows({sets[0], subjects[0].layout, encoder},
                    make_gatherers(bake, subjects[0], knobs, context), context, traced)
            .rows;
    details = rows.index16.size();
    std::vector<std::vector<float>> texels(kPoints * kPoints,
                                           std::vector<float>(formats::cubemap_texels(kFloorSide)));
    std::vector<float> scratch(kFloorSide * kFloorSide);
    for (std::uint32_t v = 0; v < texels.size(); ++v) {
        formats::decode_row(rows.view(), {0, kPoints * kPoints, 1, 0, 0}, v, 0, texels[v]);
        for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
            formats::haar_inverse(
                std::span(texels[v]).subspan(face * scratch.size(), scratch.size()), kFloorSide,
                scratch);
        }
    }
    return texels;
}

// By how much a vertex differs from the mean of the four around it.
double apart(const std::vector<std::vector<float>>& texels, std::uint32_t v, std::uint32_t sun) {
    const auto of = [&](std::uint32_t vertex) { return static_cast<double>(texels[vertex][sun]); };
    return of(v) - (of(v - 1) + of(v + 1) + of(v - kPoints) + of(v + kPoints)) / 4;
}

// Of 384 coefficients 64 remain, so that a sun's light on the floor errs by some percent. Where
// that differs from vertex to vertex, it is seen as blotches: it has to err alike.
TEST(GatherRows, DroppedCoefficientsLeaveNoBlotchesOnAFloorInTheSun) {
    const formats::Scene scene = set_floor();
    constexpr std::uint32_t kKept = 64;
    std::size_t all_details = 0, details = 0;
    const auto all = bake_floor(scene, kAllCoefficients, all_details);
    const auto some = bake_floor(scene, kKept, details);
    EXPECT_LE(details, kPoints * kPoints * (kKept - 6));
    EXPECT_GT(details, 0.9 * kPoints * kPoints * (kKept - 6));
    double squares = 0;
    int suns = 0;
    for (std::uint32_t j = 0; j < formats::cubemap_texels(kFloorSide); ++j) {
        const float height = formats::texel_direction(kFloorSide, j / (kFloorSide * kFloorSide),
                                                      j / kFloorSide % kFloorSide, j % kFloorSide)
                                 .y;
        if (height < 0.4f) continue;
        std::vector<double> errors;
        for (std::uint32_t row = 1; row < kCells; ++row) {
            for (std::uint32_t column = 1; column < kCells; ++column) {
                const std::uint32_t v = row * kPoints + column;
                errors.push_back(std::abs(apart(some, v, j) - apart(all, v, j)));
            }
        }
        // The median: at edges of shadows errors differ with what they are errors of.
        const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
        std::nth_element(errors.begin(), middle, errors.end());
        const double open = static_cast<double>(height) / std::numbers::pi;
        squares += *middle / open * (*middle / open);
        ++suns;
    }
    ASSERT_GT(suns, 60);
    // .0044 where each vertex chose its own 64.
    EXPECT_LT(std::sqrt(squares / suns), 0.0015);
}

// A user who asks for few walks gets no more of them on the way; one who asks for many waits for
// few in each step.
TEST(CoarseKnobs, TakeNoMoreThanTheFileAndNoMoreThanAStepNeeds) {
    const auto coarse = [](double walks, double epsilon) {
        BakeOptions options;
        options.quality = Quality::production;
        options.set(kWalks, walks);
        options.set(kEpsilon, epsilon);
        return coarse_knobs(all_effects(), resolve_knobs(options).value(), 8);
    };
    EXPECT_EQ(coarse(20000, 1e-3)[kWalks], 20000);
    EXPECT_EQ(coarse(5e6, 1e-3)[kWalks], kWalks.coarse);
    EXPECT_EQ(coarse(5e6, 1e-5)[kEpsilon], kEpsilon.preset.front());
    EXPECT_EQ(coarse(5e6, 1e-3).cubemap_size, 8u);
}

// Light in the place of the environment, by columns that stand for anything: a medium's answer is
// linear in it. What is left of the subject is its study.
TEST(RowsOfPoints, AreLinearInLightThatReplacesTheEnvironment) {
    const auto setup = tests::set_up(
        tests::make_translucent_scene({tests::make_sphere(2)}, tests::make_grey_medium(6, 0.3f)),
        4);
    Knobs knobs;
    knobs.cubemap_size = 1;
    knobs.effects = {"multiple"};
    knobs.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
    knobs.set(kSamples, 500);
    const SceneFacts facts = inspect_scene(setup.scene);
    const std::vector<ReceiverSet> sets = tests::receivers_of(setup);
    const auto sky = RayScene::build({}, 1);
    formats::Scene lamps = setup.scene;
    lamps.lights = {{.name = "red", .intensity = {1, 0, 0}, .position = {0, 0, 5}},
                    {.name = "green", .intensity = {2, 4, 0}, .position = {0, 0, 5}}};
    const auto sources = tests::all_sources(lamps);
    const LampLight straight{lamps, setup.rays, sources, 16};
    const LampBounces alone{straight};
    const OtherLight light{.lamps = &alone, .environment = false};
    BakeInputs bake{all_effects(), setup.scene, facts, setup.rays, *sky, sets, &light};
    const std::vector<PlanEntry> plan = plan_bake(setup.scene, facts, knobs);
    std::vector<SubjectState> subjects = begin_subjects(bake, plan, knobs);
    subjects[0].layout.coloured = true;
    StageLog log;
    const Context context;
    run_step(Step::study, bake, knobs, context, subjects, log);
    std::uint64_t rays = 0;
    const auto rows =
        rows_of_points(bake, knobs, context, subjects[0], std::span(sets[0].outside).first(9),
                       std::span(sets[0].inside).first(9), rays);
    ASSERT_EQ(rows.size(), 9u);
    EXPECT_GT(rays, 0u);
    for (const std::vector<float>& row : rows) {
        ASSERT_EQ(row.size(), subjects[0].layout.terms() * 3 * 6u);
        EXPECT_GT(row[0], 0);
        EXPECT_NEAR(row[1], 2 * row[0], 1e-4f * row[0]);
        EXPECT_NEAR(row[6 + 1], 4 * row[0], 1e-3f * row[0]) << "the medium is grey";
        EXPECT_EQ(row[2], 0);
        EXPECT_EQ(row[6], 0);
    }
    EXPECT_TRUE(std::ranges::all_of(subjects[0].effects, [](const EffectState& effect) {
        return effect.samples == nullptr && effect.prepared == nullptr;
    }));
    EXPECT_TRUE(std::ranges::any_of(
        subjects[0].effects, [](const EffectState& effect) { return effect.study != nullptr; }));
}

}  // namespace

}  // namespace opaline::bake
