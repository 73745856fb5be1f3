#include "bake/effects/rows/gather_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bake/effects/rows/shared_batches.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/single/single_support.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

using tests::make_grey_medium;

// Rows of single scattering alone at the points of a setup, in the order of the points.
formats::SparseRows bake_single_alone(const tests::SingleSetup& setup, const Knobs& wanted,
                                      std::uint32_t terms,
                                      std::size_t batch_bytes = std::size_t{1} << 30) {
    Knobs knobs = wanted;
    knobs.coefficients = kAllCoefficients;
    knobs.code_bits = 16;
    knobs.effects = {"single"};
    const SceneFacts facts = inspect_scene(setup.scene);
    const std::vector<ReceiverSet> sets = tests::receivers_of(setup);
    const auto sky = RayScene::build({}, 1);
    const BakeInputs bake{all_effects(), setup.scene, facts, setup.rays, *sky, sets};
    std::vector<PlanEntry> plan = plan_bake(setup.scene, facts, knobs);
    for (PlanEntry& entry : plan) {
        entry.on = entry.on || entry.name == "light.colour";  // three bands
    }
    std::vector<SubjectState> subjects = begin_subjects(bake, plan, knobs);
    subjects[0].layout.harmonics = terms;
    StageLog log;
    const Context context;
    run_step(Step::prepare, bake, knobs, context, subjects, log);
    const RowEncoder encoder =
        make_row_encoder(knobs.cubemap_size, knobs.coefficients, knobs.code_bits);
    std::uint64_t rays = 0;
    return gather_rows({sets[0], subjects[0].layout, encoder, 0, batch_bytes},
                       make_gatherers(bake, subjects[0], knobs, context), context, rays)
        .rows;
}

Knobs knobs_of(std::uint32_t cubemap, std::uint32_t single_cubemap, bool exact_rays = false) {
    Knobs knobs;
    knobs.cubemap_size = cubemap;
    knobs.exact_rays = exact_rays;
    knobs.set(kSingleCubemap, single_cubemap);
    knobs.set(kDepthSamples, 4);
    return knobs;
}

// <T, 1> of the first band of each receiver: coefficient sums need the light's transform, the face
// averages alone give the mean over each face.
double mean_over_faces(const formats::SparseRows& rows, std::uint32_t n, std::uint32_t row,
                       std::uint32_t count) {
    std::vector<float> dense(6 * n * n);
    formats::decode_row(rows.view(), {0, count, 3, 0, 0}, row, 0, dense);
    double sum = 0;
    for (std::size_t face = 0; face < 6; ++face) {
        sum += static_cast<double>(dense[face * n * n]) / n;  // face average times n
    }
    return sum / 6;
}

tests::SingleSetup small_ball() {
    return tests::set_up(
        tests::make_translucent_scene({tests::make_sphere(2)}, make_grey_medium(6, 0.3f)), 4);
}

TEST(GatherRows, SmallerCubeMapOfSingleScatteringMeansTheSameRadiance) {
    const auto setup = small_ball();
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto own = bake_single_alone(setup, knobs_of(16, 16), 1);
    const auto coarse = bake_single_alone(setup, knobs_of(16, 8), 1);
    for (std::uint32_t v = 0; v < count; v += 17) {
        const double a = mean_over_faces(own, 16, v, count);
        // The same function on texels twice as wide; a wrong scale would be a factor of two.
        EXPECT_NEAR(mean_over_faces(coarse, 16, v, count), a, 0.03 * a) << v;
    }
}

TEST(GatherRows, RowsDoNotDependOnTheMemoryOfABatch) {
    const auto setup = small_ball();
    const auto whole = bake_single_alone(setup, knobs_of(8, 8, false), 4);
    const auto cut = bake_single_alone(setup, knobs_of(8, 8, false), 4, 40 * 4 * 384 * 4);
    EXPECT_EQ(whole.row_offset, cut.row_offset);
    EXPECT_EQ(whole.index16, cut.index16);
    EXPECT_EQ(whole.code16, cut.code16);
    EXPECT_EQ(whole.average_code, cut.average_code);
    EXPECT_EQ(whole.detail_scale, cut.detail_scale);
}

// Three balls of one medium: two share a batch, and the third, for which there is no room, has its
// own.
TEST(GatherRows, RowsOfSetsThatShareABatchAreThoseOfEachAlone) {
    std::vector<formats::Primitive> balls;
    for (int i = 0; i < 3; ++i) {
        balls.push_back(tests::make_sphere(2, 1, {2.5f * static_cast<float>(i), 0, 0}));
    }
    const formats::Scene scene = tests::make_translucent_scene(balls, make_grey_medium(6, 0.3f));
    Knobs knobs = knobs_of(8, 8);
    knobs.coefficients = kAllCoefficients;
    knobs.effects = {"single"};
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
    const RowEncoder encoder = make_row_encoder(8, kAllCoefficients, 16);
    const std::size_t a_row = 384 * 2;  // packed, one band
    SharedBatches batches(bake, subjects, knobs, context, 5 * sets[0].size() / 2 * a_row);
    for (std::size_t s = 0; s < sets.size(); ++s) {
        std::uint64_t traced = 0, traced_alone = 0;
        const SharedBatches::Found found = batches.find(s, traced);
        EXPECT_EQ(found.gatherers != nullptr, s < 2) << s;
        RowJob job{sets[s], subjects[0].layout, encoder};
        const auto gather = [&](std::uint64_t& counted) {
            return gather_rows(job, make_gatherers(bake, subjects[0], knobs, context), context,
                               counted)
                .rows;
        };
        const formats::SparseRows alone = gather(traced_alone);
        job.shared = found.gatherers;
        job.place = found.place;
        const formats::SparseRows shared = gather(traced);
        EXPECT_EQ(shared.row_offset, alone.row_offset) << s;
        EXPECT_EQ(shared.index16, alone.index16) << s;
        EXPECT_EQ(shared.code16, alone.code16) << s;
        EXPECT_EQ(shared.average_code, alone.average_code) << s;
        EXPECT_EQ(shared.detail_scale, alone.detail_scale) << s;
    }
}

TEST(GatherRows, RowsStandAsReceiversAreGivenInWhateverOrder) {
    const auto setup = small_ball();
    auto shuffled = small_ball();
    std::reverse(shuffled.points.begin(), shuffled.points.end());
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto rows = bake_single_alone(setup, knobs_of(8, 8, false), 4);
    const auto other = bake_single_alone(shuffled, knobs_of(8, 8, false), 4);
    constexpr std::uint32_t kTerms = 4;
    std::vector<float> expected(6 * 8 * 8), actual(expected.size());
    for (std::uint32_t v = 0; v < count; ++v) {
        for (std::uint32_t k = 0; k < kTerms; ++k) {
            const std::uint32_t mirrored = (count - 1 - v) * kTerms + k;
            formats::decode_row(rows.view(), {0, kTerms * count, 3, 0, 0}, kTerms * v + k, 1,
                                expected);
            formats::decode_row(other.view(), {0, kTerms * count, 3, 0, 0}, mirrored, 1, actual);
            ASSERT_EQ(actual, expected) << v << ' ' << k;
        }
    }
}

TEST(GatherRows, RaysGiveWhatLightMapsGive) {
    const auto setup = small_ball();
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto maps = bake_single_alone(setup, knobs_of(8, 8, false), 1);
    const auto rays = bake_single_alone(setup, knobs_of(8, 8, true), 1, 30 * 4 * 18 * 64);
    for (std::uint32_t v = 0; v < count; v += 17) {
        const double a = mean_over_faces(rays, 8, v, count);
        // One direction a texel against four.
        EXPECT_NEAR(mean_over_faces(maps, 8, v, count), a, 0.03 * a) << v;
    }
}

}  // namespace
}  // namespace opaline::bake
