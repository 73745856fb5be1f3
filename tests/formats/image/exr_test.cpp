#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/image/chromaticities.h"
#include "formats/image/exr.h"
#include "formats/image/exr_layer.h"
#include "formats/image/image_kind.h"
#include "tests/formats/image/image_files.h"

namespace opaline::formats {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Result<ExrImage> decode(const std::string& bytes) {
    return decode_exr(as_bytes(bytes), "x.exr");
}

TEST(Exr, RoundTripKeepsEveryBit) {
    Image image = ramp(37, 21);
    image.pixel[3] = {-1.5f, std::numeric_limits<float>::infinity(), 3e38f};
    const auto path = temporary("round.exr");
    ASSERT_TRUE(write_exr(path, image));
    const Image read = must(read_exr(path));
    EXPECT_EQ(read.width, 37u);
    EXPECT_EQ(read.height, 21u);
    EXPECT_EQ(read.pixel, image.pixel);
    std::filesystem::remove(path);
}

TEST(Exr, ReadsEveryLosslessCompressionTypeAndLayout) {
    // Powers of two survive the 16-bit and 24-bit types exactly.
    Image image{40, 35, {}};
    for (int i = 0; i < 40 * 35; ++i) {
        image.pixel.push_back(
            {std::ldexp(1.0f, i % 9), std::ldexp(1.0f, -(i % 5)), std::ldexp(1.0f, i % 3)});
    }
    for (const int compression : {0, 1, 2, 3, 4, 5}) {
        for (int bits = 0; bits < 16; ++bits) {
            const ExrStyle style{.compression = compression,
                                 .is_half = (bits & 1) != 0,
                                 .is_tiled = (bits & 2) != 0,
                                 .has_alpha = (bits & 4) != 0,
                                 .min_x = (bits & 8) != 0 ? -7 : 0,
                                 .min_y = (bits & 8) != 0 ? 1000 : 0};
            const ExrImage read = must(decode(make_exr(image, style)));
            EXPECT_EQ(read.image.pixel, image.pixel) << compression << " " << bits;
            EXPECT_TRUE(read.warnings.empty());
        }
    }
}

TEST(Exr, ReadsLossyCompressionsClosely) {
    Image image{64, 300, std::vector<Rgb>(64 * 300, {0.5f, 2.0f, 8.0f})};
    for (const int compression : {6, 7, 8, 9}) {
        const ExrImage read =
            must(decode(make_exr(image, {.compression = compression, .is_half = true})));
        for (const Rgb& c : read.image.pixel) {  // a constant costs these codecs about 1 %
            ASSERT_NEAR(c.r, 0.5f, 0.01f);
            ASSERT_NEAR(c.g, 2.0f, 0.04f);
            ASSERT_NEAR(c.b, 8.0f, 0.16f);
        }
    }
}

TEST(Exr, LuminanceAloneBecomesGrey) {
    const Image image = ramp(8, 4);
    const ExrImage read = must(decode(make_exr(image, {.is_grey = true})));
    for (std::size_t i = 0; i < image.pixel.size(); ++i) {
        const float y = image.pixel[i].r;
        EXPECT_EQ(read.image.pixel[i], (Rgb{y, y, y}));
    }
}

TEST(Exr, OneChannelIsTheFirstNamedThatTheFileHolds) {
    const Image image = ramp(8, 5);
    const std::string color = make_exr(image, {.is_half = true, .has_alpha = true, .min_x = -7});
    const ScalarImage red = must(decode_exr_channel(as_bytes(color), "x.exr", {"Y", "R"}, 8));
    const ScalarImage alpha = must(decode_exr_channel(as_bytes(color), "x.exr", {"A", "R"}, 8));
    const ExrImage whole = must(decode(color));
    ASSERT_EQ(red.width, 8u);
    ASSERT_EQ(red.height, 5u);
    ASSERT_EQ(red.value.size(), 40u);
    for (std::size_t i = 0; i < red.value.size(); ++i) {
        EXPECT_EQ(red.value[i], whole.image.pixel[i].r);
        EXPECT_EQ(alpha.value[i], 0.25f);
    }
    EXPECT_THAT(refusal(decode_exr_channel(as_bytes(color), "x.exr", {"Y", "Z"}, 8)),
                HasSubstr("no channel Y or Z"));
    EXPECT_THAT(refusal(decode_exr_channel(as_bytes(color), "x.exr", {"R"}, 7)),
                HasSubstr("the limit is 7"));
}

TEST(Exr, WithoutColourChannelsTheMessageNamesThoseFound) {
    const Result<ExrImage> read = decode(make_exr(ramp(8, 4), {.prefix = "not"}));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
    EXPECT_THAT(message(read.error()), HasSubstr("notR"));
}

TEST(Exr, ALayerOfAnyNameGivesTheColours) {
    const Image image = ramp(8, 4);
    for (const char* prefix : {"beauty.", "ViewLayer.Combined."}) {
        for (const bool is_grey : {false, true}) {
            const ExrStyle style{.is_grey = is_grey, .has_alpha = true, .prefix = prefix};
            const ExrImage read = must(decode(make_exr(image, style)));
            EXPECT_TRUE(read.warnings.empty());
            EXPECT_EQ(read.image.pixel[5].r, image.pixel[5].r);
            EXPECT_EQ(read.image.pixel[5].g, is_grey ? image.pixel[5].r : image.pixel[5].g);
        }
    }
}

TEST(Exr, TheFirstPartWithColoursIsRead) {
    const Image image = ramp(8, 4);
    const std::string bytes = make_exr_of_parts(image);
    const ExrImage read = must(decode(bytes));
    EXPECT_EQ(read.image.pixel, image.pixel);
    EXPECT_TRUE(read.warnings.empty());
    const auto depth = must(decode_exr_channel(as_bytes(bytes), "x.exr", {"Z"}, 8));
    EXPECT_EQ(depth.value[7], image.pixel[7].r);
}

// The picture's own channels come before layers, a layer that means the whole picture before
// others, and the Y of a vector is no luminance.
TEST(Exr, OfSeveralLayersTheWholePictureIsChosen) {
    const auto chosen = [](std::vector<std::string> channels) {
        ExrHeader header;
        header.full_size = std::move(channels);
        const auto layer = choose_layer({&header, 1});
        return layer ? layer->red.value_or("-") : std::string("none");
    };
    EXPECT_EQ(chosen({"AO.B", "AO.G", "AO.R", "Combined.B", "Combined.G", "Combined.R"}),
              "Combined.R");
    EXPECT_EQ(chosen({"AO.B", "AO.G", "AO.R", "B", "G", "R"}), "R");
    EXPECT_EQ(chosen({"key.blue", "key.green", "key.red"}), "key.red");
    EXPECT_EQ(chosen({"Normal.X", "Normal.Y", "Normal.Z"}), "none");
    EXPECT_EQ(chosen({"Normal.X", "Normal.Y", "Normal.Z", "light.Y"}), "light.Y");
    EXPECT_EQ(chosen({"A", "R"}), "R");
}

TEST(Exr, OtherLayersOfColoursAreNamedInAWarning) {
    const Image image = ramp(8, 4);
    const ExrImage read = must(decode(make_exr(image, {.has_layer = true})));
    EXPECT_EQ(read.image.pixel, image.pixel);
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_THAT(read.warnings[0].fault, HasSubstr("2 layers of colours"));
}

// White stays white; a colour becomes that of the same light in Rec. 709.
TEST(Exr, ColoursOfOtherPrimariesAreConverted) {
    const Chromaticities ap1{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    const Image image{2, 1, {{2, 2, 2}, {1, 0, 0}}};
    const ExrImage read = must(decode(make_exr(image, {.chromaticities = ap1})));
    EXPECT_TRUE(read.warnings.empty());
    EXPECT_NEAR(read.image.pixel[0].r, 2, 1e-4f);
    EXPECT_NEAR(read.image.pixel[0].b, 2, 1e-4f);
    EXPECT_NEAR(read.image.pixel[1].r, 1.70505f, 1e-4f);
    EXPECT_NEAR(read.image.pixel[1].g, -0.13026f, 1e-4f);
    const Chromaticities line{0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.3127f, 0.329f};
    const ExrImage odd = must(decode(make_exr(image, {.chromaticities = line})));
    EXPECT_EQ(odd.image.pixel, image.pixel);
    ASSERT_EQ(odd.warnings.size(), 1u);
    EXPECT_THAT(odd.warnings[0].fault, HasSubstr("chromaticities"));
}

TEST(Exr, WhatIsNoExrIsRefusedByName) {
    const auto path = temporary("text.exr");
    write_bytes(path, "this is a poem");
    EXPECT_THAT(refusal(read_exr(path)),
                AllOf(HasSubstr("is not an OpenEXR file"), HasSubstr(path.string())));
    std::filesystem::remove(path);
}

TEST(Exr, UnwritableFolderAndEmptyImageAreErrors) {
    EXPECT_EQ(write_exr("/nonexistent/x.exr", ramp(2, 2)).error().kind, ErrorKind::resource);
    EXPECT_EQ(write_exr(temporary("empty.exr"), Image{}).error().kind, ErrorKind::usage);
}

// Overwrites the value of a header attribute found by name and type.
std::string with_attribute(std::string bytes, const std::string& name, const std::string& type,
                           std::size_t offset, const void* value, std::size_t size) {
    const std::string key = name + '\0' + type + '\0';
    const std::size_t at = bytes.find(key);
    EXPECT_NE(at, std::string::npos);
    std::memcpy(bytes.data() + at + key.size() + 4 + offset, value, size);
    return bytes;
}

// 134 million pixels, 1.6 GB, in a file of 1.6 MB: its chunk table would fit.
TEST(Exr, SmallFileCannotCostGigabytes) {
    std::string bytes = make_exr(ramp(16, 16), {});
    const std::int32_t right = 16383, bottom = 8191;
    bytes = with_attribute(bytes, "dataWindow", "box2i", 8, &right, 4);
    bytes = with_attribute(bytes, "dataWindow", "box2i", 12, &bottom, 4);
    bytes.resize(1600000);
    EXPECT_THAT(refusal(decode(bytes)), HasSubstr("claims 16384 x 8192 pixels in 1600000 bytes"));
}

TEST(Exr, LargeFlatMapsAndLargePhotographsArePlausible) {
    EXPECT_TRUE(is_plausible_size(4096, 2048, 100000));     // a sun over black
    EXPECT_TRUE(is_plausible_size(16384, 8192, 60000000));  // a photograph
    EXPECT_FALSE(is_plausible_size(16384, 8192, 1600000));
}

TEST(Exr, HeadersThatClaimTooMuchAreRefusedBeforeAllocating) {
    const std::string honest = make_exr(ramp(16, 16), {.is_tiled = true});
    const auto refused = [](const std::string& bytes) { return refusal(decode(bytes)); };
    const std::int32_t huge = 1 << 20, edge = std::numeric_limits<std::int32_t>::max();
    const auto window = [&](std::size_t offset, std::int32_t value) {
        return with_attribute(honest, "dataWindow", "box2i", offset, &value, 4);
    };
    EXPECT_THAT(refused(window(8, huge)), HasSubstr("claims"));
    EXPECT_THAT(refused(window(12, edge)), HasSubstr("claims"));
    EXPECT_THAT(refused(window(0, 100)), HasSubstr("claims"));  // x from 100 to 15
    const std::uint32_t tile = 16384;
    const std::string wide = with_attribute(honest, "tiles", "tiledesc", 0, &tile, 4);
    EXPECT_THAT(refused(with_attribute(wide, "tiles", "tiledesc", 4, &tile, 4)),
                HasSubstr("chunks would take"));
    const std::uint32_t zero = 0, one = 1;
    EXPECT_THAT(refused(with_attribute(honest, "tiles", "tiledesc", 0, &zero, 4)),
                HasSubstr("tile description"));
    // 2000 x 2000 tiles of one pixel: a table of 32 MB in a file of a few kB.
    const std::int32_t side = 1999;
    std::string many = with_attribute(honest, "tiles", "tiledesc", 0, &one, 4);
    many = with_attribute(many, "tiles", "tiledesc", 4, &one, 4);
    many = with_attribute(many, "dataWindow", "box2i", 8, &side, 4);
    many = with_attribute(many, "dataWindow", "box2i", 12, &side, 4);
    EXPECT_THAT(refused(many), HasSubstr("table of"));
    // A preview that claims 2^31 pixels is never parsed: the image itself is fine.
    const std::uint32_t claim = 1u << 16;
    std::string preview = with_attribute(honest, "preview", "preview", 0, &claim, 4);
    preview = with_attribute(preview, "preview", "preview", 4, &claim, 4);
    EXPECT_EQ(refused(preview), "accepted");
    std::string parts = honest;
    parts[5] = static_cast<char>(parts[5] | 0x08);
    EXPECT_THAT(refused(parts), HasSubstr("deep data"));
}

// The matrices that the Academy (ACES 1.3, AP1 and AP0 by Bradford's adaptation), the ITU (BT.2087)
// and SMPTE (RP 431-2 primaries with D65) print.
TEST(Chromaticities, MatricesAreThePublishedOnes) {
    struct Row {
        Chromaticities from;
        std::array<double, 9> expected;  // row after row
    };
    const Row rows[]{
        {{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f},
         {1.70505, -0.62179, -0.08326, -0.13026, 1.14080, -0.01055, -0.02400, -0.12897, 1.15297}},
        {{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f},
         {2.52169, -1.13413, -0.38756, -0.27648, 1.37272, -0.09624, -0.01538, -0.15298, 1.16835}},
        {{0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f},
         {1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187}},
        {{0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.3127f, 0.329f},
         {1.2249, -0.2249, 0, -0.0420, 1.0420, 0, -0.0197, -0.0786, 1.0983}}};
    for (const Row& row : rows) {
        const auto matrix = to_rec709(row.from);
        ASSERT_TRUE(matrix);
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR((*matrix)[int(i % 3)][int(i / 3)], row.expected[i], 2e-4)
                << row.from[0] << " " << i;
        }
    }
}

TEST(Chromaticities, ImpossibleOnesHaveNoMatrix) {
    EXPECT_FALSE(to_rec709({}));
    EXPECT_FALSE(to_rec709({0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(to_rec709({nan, nan, nan, nan, nan, nan, nan, nan}));
}

}  // namespace

}  // namespace opaline::formats
