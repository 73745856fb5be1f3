#include "bake/accuracy/pilot/pilot_rows.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "bake/accuracy/stored_luminance.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "formats/opal/cubemap.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// A pilot that looks at all receivers of a floor, with a truth of 0, reads off the luminance that
// the file will show: its floor's rows choose their coefficients together, and those near the ball
// keep more than those in the open.
TEST(PilotRows, RowsAreJudgedByTheCoefficientsThatTheFileKeeps) {
    constexpr std::uint32_t kSide = 8, kKept = 48;
    const formats::Scene scene =
        tests::make_scene({tests::make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 8),
                           tests::make_sphere(2, 0.5f, {0.4f, 0.5f, 0.3f})});
    Knobs knobs;
    knobs.cubemap_size = kSide;
    knobs.coefficients = kKept;
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
    const RowEncoder encoder = make_row_encoder(kSide, kKept, 8);
    std::uint64_t traced = 0;
    const RowLayout& layout = subjects[0].layout;
    const formats::SparseRows rows =
        gather_rows({sets[0], layout, encoder}, make_gatherers(bake, subjects[0], knobs, context),
                    context, traced)
            .rows;

    TestLight sun;  // one bright texel, and some of its neighbours' light
    sun.coarse.resize(formats::cubemap_texels(kSide));
    for (std::size_t k = 0; k < sun.coarse.size(); ++k) {
        sun.coarse[k] = k % 5 == 0 ? 1.0f : -0.2f;
    }
    const std::array lights{sun};
    std::vector<PilotReceiver> pilots;
    for (std::uint32_t v = 0; v < sets[0].size(); ++v) {
        pilots.push_back({sets[0].first + v, 0, {Luminance(1), Luminance(1)}});
    }
    const PilotScene pilot{bake, subjects, lights, context};
    const auto pairs =
        PilotRows(pilot, pilots, knobs).measure(std::array{Encoding{kKept, 8}}).front();
    ASSERT_EQ(pairs.size(), sets[0].size());
    const auto count = static_cast<std::uint32_t>(sets[0].size());
    for (std::uint32_t v = 0; v < count; ++v) {
        const std::vector<float> h = view_of_rows(layout, sets[0].inside[v].normal);
        const Luminance shown =
            relight_rows({rows.view(), {0, count, layout.bands(), 0, 0}, v}, h, lights);
        EXPECT_DOUBLE_EQ(pairs[v].error[0], shown[0]) << v;
    }
}

}  // namespace
}  // namespace opaline::bake
