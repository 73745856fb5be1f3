#include "bake/lab/compare/relight_table.h"

#include <gmock/gmock.h>

#include <cfloat>
#include <cstring>
#include <fstream>
#include <iterator>

#include "formats/image/exr.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

using formats::Rgb;
using tests::TemporaryFolder;

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
