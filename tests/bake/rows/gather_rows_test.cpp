#include "bake/rows/gather_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

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
