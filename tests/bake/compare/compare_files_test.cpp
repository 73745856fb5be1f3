#include <gmock/gmock.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#include "bake/lab/compare/compare_files.h"
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

std::vector<RelightRow> rows() {
    return {{0, 0, {0.1f, 1.0f / 3.0f, FLT_MIN}},
            {0, 1, {FLT_MAX, 0, 1e-30f}},
            {4294967295u, 7, {123456.789f, 2, 3}}};
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

TEST(RelightTable, EveryFloatSurvivesTheRoundTrip) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_relight_csv(folder / "t.csv", rows()));
    const auto read = read_relight_csv(folder / "t.csv");
    ASSERT_TRUE(read);
    ASSERT_EQ(read->size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ((*read)[i].primitive, rows()[i].primitive);
        EXPECT_EQ((*read)[i].vertex, rows()[i].vertex);
        EXPECT_EQ((*read)[i].radiance, rows()[i].radiance);
    }
}

TEST(RelightTable, FurtherColumnsAndWindowsLineEndsAreRead) {
    const auto read =
        decode_relight_csv(bytes_of("primitive,vertex,r,g,b,se_r\r\n1,2,3,4,5,0.1\r\n"), "t");
    ASSERT_TRUE(read);
    EXPECT_EQ((*read)[0].radiance, (Rgb{3, 4, 5}));
}

TEST(RelightTable, MalformedLinesAreNamed) {
    const std::string head = "primitive,vertex,r,g,b\n0,0,1,1,1\n";
    for (const std::string line :
         {"0,1,1,1", "0,1,1,1,", "x,1,1,1,1", "-1,1,1,1,1", "0,1,nan,1,1", "0,1,1,inf,1",
          "0,1,1,1,1e999", "4294967296,1,1,1,1", "0 1 1 1 1"}) {
        const auto read = decode_relight_csv(bytes_of(head + line + "\n"), "t");
        ASSERT_FALSE(read) << line;
        EXPECT_EQ(read.error().kind, formats::ErrorKind::bad_input);
        EXPECT_THAT(read.error().diagnostics[0].where, testing::HasSubstr("3")) << line;
    }
}

TEST(RelightTable, PointCloudHoldsPositionsAndRadiancesInOrder) {
    const TemporaryFolder folder;
    const std::vector<formats::Vec3> positions{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    ASSERT_TRUE(write_relight_ply(folder / "t.ply", positions, rows()));
    std::ifstream file(folder / "t.ply", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_THAT(text, testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
    const std::size_t body = text.find("end_header\n") + 11;
    ASSERT_EQ(text.size() - body, 3 * 6 * sizeof(float));
    float second[6];
    std::memcpy(second, text.data() + body + 6 * sizeof(float), sizeof second);
    EXPECT_THAT(second, testing::ElementsAre(4, 5, 6, FLT_MAX, 0, 1e-30f));
}

TEST(RelightTable, PictureHoldsAThousandAndTwentyFourReceiversARow) {
    const TemporaryFolder folder;
    std::vector<RelightRow> many(1500);
    many[1030].radiance = {1, 2, 3};
    ASSERT_TRUE(write_relight_exr(folder / "t.exr", many));
    const auto image = formats::read_exr(folder / "t.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 1024u);
    EXPECT_EQ(image->height, 2u);
    EXPECT_EQ(image->pixel[1030], (Rgb{1, 2, 3}));
    EXPECT_EQ(image->pixel[2047], (Rgb{}));
}

}  // namespace

}  // namespace opaline::bake
