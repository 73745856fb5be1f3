#include "bake/lab/compare/compare_files.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bake/lab/compare/relight_table.h"
#include "formats/image/exr.h"
#include "formats/image/png.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

using formats::Rgb;
using tests::TemporaryFolder;

TEST(Compare, ErrorsHaveTheirClosedForms) {
    // One element of twenty is off by (0.3, 0, 0): its error is 0.3 / sqrt 3.
    std::vector<Rgb> b(20, Rgb{2, 2, 2}), a = b;
    a[7].r += 0.3f;
    const Comparison c = compare_values(a, b);
    const double error = 0.3 / std::sqrt(3.0);
    EXPECT_EQ(c.count, 20u);
    EXPECT_NEAR(c.maximum, error, 1e-6);
    EXPECT_NEAR(c.rmse, error / std::sqrt(20.0), 1e-6);
    EXPECT_NEAR(c.relative_rmse, error / std::sqrt(20.0) / 2, 1e-6);
    EXPECT_EQ(c.p95, 0);  // the 19th of 20
    a[8].g += 0.3f;
    EXPECT_NEAR(compare_values(a, b).p95, error, 1e-6);
}

TEST(Compare, BlackReferenceIsMatchedByBlackAlone) {
    const std::vector<Rgb> black(3), grey(3, Rgb{1, 1, 1});
    EXPECT_EQ(compare_values(black, black).relative_rmse, 0);
    EXPECT_TRUE(std::isinf(compare_values(grey, black).relative_rmse));
}

TEST(Compare, TablesMatchByReceiverWhateverTheirOrder) {
    const TemporaryFolder folder;
    const std::vector<RelightRow> rows{{0, 0, {1, 2, 3}}, {0, 1, {4, 5, 6}}, {1, 0, {7, 8, 9}}};
    const std::vector<RelightRow> shuffled{rows[2], rows[0], rows[1]};
    ASSERT_TRUE(write_relight_csv(folder / "a.csv", rows));
    ASSERT_TRUE(write_relight_csv(folder / "b.csv", shuffled));
    const auto c = compare_files(folder / "a.csv", folder / "b.csv");
    ASSERT_TRUE(c);
    EXPECT_EQ(c->maximum, 0);
    EXPECT_EQ(c->count, 3u);
}

TEST(Compare, TablesOfOtherReceiversAreRefused) {
    const TemporaryFolder folder;
    const std::vector<RelightRow> rows{{0, 0, {1, 2, 3}}, {0, 1, {4, 5, 6}}};
    const std::vector<std::vector<RelightRow>> others{
        {rows[0]}, {rows[0], rows[0]}, {rows[0], {1, 1, {4, 5, 6}}}};
    ASSERT_TRUE(write_relight_csv(folder / "a.csv", rows));
    for (const auto& other : others) {
        ASSERT_TRUE(write_relight_csv(folder / "b.csv", other));
        const auto c = compare_files(folder / "a.csv", folder / "b.csv");
        ASSERT_FALSE(c);
        EXPECT_EQ(c.error().kind, formats::ErrorKind::bad_input);
    }
}

TEST(Compare, PicturesOfOtherSizesOrWithoutNumbersAreRefused) {
    const TemporaryFolder folder;
    formats::Image image{4, 2, std::vector<Rgb>(8, Rgb{1, 1, 1})};
    ASSERT_TRUE(formats::write_exr(folder / "a.exr", image));
    ASSERT_TRUE(formats::write_exr(folder / "b.exr", {2, 4, image.pixel}));
    EXPECT_FALSE(compare_files(folder / "a.exr", folder / "b.exr"));
    image.pixel[3].g = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(formats::write_exr(folder / "b.exr", image));
    const auto c = compare_files(folder / "a.exr", folder / "b.exr");
    ASSERT_FALSE(c);
    EXPECT_THAT(c.error().diagnostics[0].file, testing::EndsWith("b.exr"));
}

TEST(Compare, PngIsComparedInLinearLight) {
    const TemporaryFolder folder;
    // sRGB 188 is a linear 0.5029, by IEC 61966-2-1.
    const double linear = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    const auto value = static_cast<float>(linear);
    ASSERT_TRUE(formats::write_exr(folder / "a.exr", {1, 1, {Rgb{value, value, value}}}));
    ASSERT_TRUE(formats::write_png(folder / "b.png", {1, 1, {188, 188, 188, 255}}));
    const auto c = compare_files(folder / "a.exr", folder / "b.png");
    ASSERT_TRUE(c);
    EXPECT_LT(c->maximum, 1e-6);
}

}  // namespace
}  // namespace opaline::bake
