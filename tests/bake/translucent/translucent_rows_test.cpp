#include "bake/translucent/translucent_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "formats/opal/cubemap.h"
#include "tests/bake/single/single_support.h"

namespace opaline::bake {
namespace {

using tests::make_grey_medium;

formats::SparseRows bake_single_alone(const tests::SingleSetup& setup, const SingleOptions& options,
                                      std::uint32_t n, std::size_t batch_bytes) {
    const SingleStage stage = prepare_single(setup.scene, setup.rays, 0, options, {});
    TranslucentRecipe recipe;
    recipe.layout.translucent = true;
    recipe.layout.single_terms = options.terms;
    recipe.single = &stage;
    recipe.selector = make_selector(n, 6 * n * n);
    recipe.code_bits = 16;
    recipe.batch_bytes = batch_bytes;
    EntryCounts counts;
    const std::vector<Receiver> receivers(setup.points.size());
    return bake_translucent(recipe, setup.rays, receivers, setup.points, {}, counts);
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

TEST(TranslucentRows, SmallerCubeMapOfSingleScatteringMeansTheSameRadiance) {
    const auto setup = small_ball();
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto own = bake_single_alone(setup, {16, 4, 1, false}, 16, std::size_t{1} << 30);
    const auto coarse = bake_single_alone(setup, {8, 4, 1, false}, 16, std::size_t{1} << 30);
    for (std::uint32_t v = 0; v < count; v += 17) {
        const double a = mean_over_faces(own, 16, v, count);
        // The same function on texels twice as wide; a wrong scale would be a factor of two.
        EXPECT_NEAR(mean_over_faces(coarse, 16, v, count), a, 0.03 * a) << v;
    }
}

TEST(TranslucentRows, RowsDoNotDependOnTheMemoryOfABatch) {
    const auto setup = small_ball();
    const auto whole = bake_single_alone(setup, {8, 4, 4, false}, 8, std::size_t{1} << 30);
    const auto cut = bake_single_alone(setup, {8, 4, 4, false}, 8, 40 * 4 * 384 * 4);
    EXPECT_EQ(whole.row_offset, cut.row_offset);
    EXPECT_EQ(whole.index16, cut.index16);
    EXPECT_EQ(whole.code16, cut.code16);
    EXPECT_EQ(whole.average_code, cut.average_code);
    EXPECT_EQ(whole.detail_scale, cut.detail_scale);
}

TEST(TranslucentRows, RowsStandAsReceiversAreGivenInWhateverOrder) {
    const auto setup = small_ball();
    auto shuffled = small_ball();
    std::reverse(shuffled.points.begin(), shuffled.points.end());
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto rows = bake_single_alone(setup, {8, 4, 4, false}, 8, std::size_t{1} << 30);
    const auto other = bake_single_alone(shuffled, {8, 4, 4, false}, 8, std::size_t{1} << 30);
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

TEST(TranslucentRows, RaysGiveWhatLightMapsGive) {
    const auto setup = small_ball();
    const auto count = static_cast<std::uint32_t>(setup.points.size());
    const auto maps = bake_single_alone(setup, {8, 4, 1, false}, 8, std::size_t{1} << 30);
    const auto rays = bake_single_alone(setup, {8, 4, 1, true}, 8, 30 * 4 * 18 * 64);
    for (std::uint32_t v = 0; v < count; v += 17) {
        const double a = mean_over_faces(rays, 8, v, count);
        // One direction a texel against four.
        EXPECT_NEAR(mean_over_faces(maps, 8, v, count), a, 0.03 * a) << v;
    }
}

}  // namespace
}  // namespace opaline::bake
