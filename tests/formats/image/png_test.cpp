#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "formats/image/png.h"
#include "formats/image/srgb.h"
#include "tests/formats/image/image_files.h"

namespace opaline::formats {
namespace {

Image8 pattern(std::uint32_t width, std::uint32_t height, bool is_opaque) {
    Image8 image{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        for (const std::uint32_t step : {1u, 3u, 7u}) {
            image.rgba.push_back(static_cast<std::uint8_t>(i * step));
        }
        image.rgba.push_back(is_opaque ? std::uint8_t{255} : static_cast<std::uint8_t>(i));
    }
    return image;
}

TEST(Png, RoundTripKeepsEveryByte) {
    for (const bool is_opaque : {true, false}) {
        const Image8 image = pattern(19, 23, is_opaque);
        const auto path = temporary("round.png");
        ASSERT_TRUE(write_png(path, image));
        const Image8 read = must(read_png(path));
        EXPECT_EQ(read.width, 19u);
        EXPECT_EQ(read.height, 23u);
        EXPECT_EQ(read.rgba, image.rgba);
        std::filesystem::remove(path);
    }
}

TEST(Png, BadSizesAndFoldersAreErrors) {
    EXPECT_EQ(write_png(temporary("x.png"), Image8{}).error().kind, ErrorKind::usage);
    EXPECT_EQ(write_png(temporary("x.png"), Image8{2, 2, {1, 2, 3}}).error().kind,
              ErrorKind::usage);
    EXPECT_EQ(write_png("/nonexistent/x.png", pattern(2, 2, true)).error().kind,
              ErrorKind::resource);
}

TEST(Png, HeaderThatClaimsTooMuchIsRefused) {
    const auto path = temporary("small.png");
    ASSERT_TRUE(write_png(path, pattern(2, 2, true)));
    std::string bytes = read_bytes(path);
    std::filesystem::remove(path);
    // IHDR: 16384 x 16384, with its new check sum (CRC-32 computed bit by bit).
    bytes.replace(16, 8, std::string("\x00\x00\x40\x00\x00\x00\x40\x00", 8));
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= static_cast<unsigned char>(bytes[i]);
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
        }
    }
    crc = ~crc;
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
    }
    EXPECT_THAT(refusal(decode_png(as_bytes(bytes), "x.png")),
                testing::HasSubstr("claims 16384 x 16384"));
}

TEST(Srgb, EveryCodeSurvivesTheRoundTrip) {
    const Image8 image = pattern(256, 1, true);
    EXPECT_EQ(to_srgb(to_linear(image)).rgba, image.rgba);
    // Middle grey of 18 % encodes to 46.1 % (IEC 61966-2-1).
    EXPECT_NEAR(srgb_from_linear(0.18f), 0.4613f, 1e-4f);
    EXPECT_EQ(srgb_from_linear(-1.0f), 0.0f);
    EXPECT_EQ(srgb_from_linear(7.0f), 1.0f);
}

// Every byte of these carries the image; a tiled file ends with smaller levels, not looked at.
// Other damage: tests/fuzz.
TEST(DamagedImages, WithoutTheirLastByteAreRefused) {
    const std::string exr = make_exr(ramp(12, 6), {});
    EXPECT_FALSE(decode_exr(as_bytes(exr.substr(0, exr.size() - 1)), "x"));
    const std::string hdr = "#?RADIANCE\n\n-Y 1 +X 2\n" + std::string(8, 'x');
    ASSERT_TRUE(decode_hdr(as_bytes(hdr), "x"));
    EXPECT_FALSE(decode_hdr(as_bytes(hdr.substr(0, hdr.size() - 1)), "x"));
}

}  // namespace

}  // namespace opaline::formats
