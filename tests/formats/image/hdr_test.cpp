#include "formats/image/hdr.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "tests/formats/image/image_files.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;

using Code = std::array<unsigned char, 4>;

std::string head(int width, int height, const std::string& lines = "") {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y " + std::to_string(height) +
           " +X " + std::to_string(width) + "\n";
}

// Pixels with short and long runs, and a pixel (1, 1, 1, n) nowhere.
std::vector<Code> codes(int width, int height) {
    std::vector<Code> result;
    for (int i = 0; i < width * height; ++i) {
        const auto step = static_cast<unsigned char>(i / 5 * 7);
        result.push_back({step, static_cast<unsigned char>(i % width < width / 2 ? 200 : i),
                          static_cast<unsigned char>(128),
                          static_cast<unsigned char>(120 + i % 3)});
    }
    return result;
}

Rgb value(Code c) {
    const double step = std::ldexp(1.0, c[3] - 136);
    return c[3] == 0 ? Rgb{}
                     : Rgb{static_cast<float>(c[0] * step), static_cast<float>(c[1] * step),
                           static_cast<float>(c[2] * step)};
}

std::string flat(const std::vector<Code>& pixels) {
    std::string bytes;
    for (const Code& c : pixels) {
        bytes.append(c.begin(), c.end());
    }
    return bytes;
}

std::string new_runs(const std::vector<Code>& pixels, std::size_t width) {
    std::string bytes;
    for (std::size_t first = 0; first < pixels.size(); first += width) {
        bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (std::size_t component = 0; component < 4; ++component) {
            for (std::size_t x = 0; x < width;) {
                const auto at = [&](std::size_t i) { return pixels[first + i][component]; };
                std::size_t run = 1;
                while (x + run < width && run < 127 && at(x + run) == at(x)) {
                    ++run;
                }
                if (run > 1) {
                    bytes += {static_cast<char>(128 + run), static_cast<char>(at(x))};
                } else {
                    bytes += {1, static_cast<char>(at(x))};
                }
                x += run;
            }
        }
    }
    return bytes;
}

std::string old_runs(const std::vector<Code>& pixels, std::size_t width) {
    std::string bytes;
    for (std::size_t first = 0; first < pixels.size(); first += width) {
        for (std::size_t x = 0; x < width;) {
            const Code c = pixels[first + x];
            std::size_t run = 1;
            while (x + run < width && pixels[first + x + run] == c) {
                ++run;
            }
            bytes.append(c.begin(), c.end());
            // The repetitions, least significant byte first.
            for (std::size_t rest = run - 1; rest > 0; rest >>= 8) {
                bytes += {1, 1, 1, static_cast<char>(rest & 255)};
            }
            x += run;
        }
    }
    return bytes;
}

void expect_decodes(const std::string& bytes, const std::vector<Code>& pixels) {
    const HdrImage read = must(decode_hdr(as_bytes(bytes), "x.hdr"));
    std::vector<Rgb> expected;
    for (const Code& code : pixels) {
        expected.push_back(value(code));
    }
    EXPECT_TRUE(read.image.pixel == expected);
}

TEST(Hdr, FlatOldAndNewRunsGiveTheSamePixels) {
    const auto pixels = codes(300, 4);
    expect_decodes(head(300, 4) + flat(pixels), pixels);
    expect_decodes(head(300, 4) + old_runs(pixels, 300), pixels);
    expect_decodes(head(300, 4) + new_runs(pixels, 300), pixels);
    const std::vector<Code> constant(600 * 2, Code{10, 20, 30, 128});  // runs over 255: two markers
    expect_decodes(head(600, 2) + old_runs(constant, 600), constant);
    expect_decodes(head(600, 2) + new_runs(constant, 600), constant);
}

TEST(Hdr, ZeroExponentIsBlackAndExposureIsDividedOut) {
    const std::vector<Code> pixels{{255, 255, 255, 0}, {128, 64, 32, 129}};
    const std::string bytes = head(2, 1, "EXPOSURE= 4.0\nEXPOSURE=0.5\n") + flat(pixels);
    const HdrImage read = must(decode_hdr(as_bytes(bytes), "x.hdr"));
    EXPECT_EQ(read.image.pixel[0], (Rgb{0, 0, 0}));
    EXPECT_EQ(read.image.pixel[1], (Rgb{0.5f, 0.25f, 0.125f}));  // (1, .5, .25) / (4 * 0.5)
    EXPECT_EQ(read.warnings.size(), 1u);
}

// Radiance's refer, "Picture file format": the first axis is that of the scan lines, X grows to the
// right and Y upwards. Each text stores the same picture of 9 x 10 pixels.
TEST(Hdr, EveryOrientationGivesTheSamePicture) {
    const std::uint64_t width = 9, height = 10;
    const auto pixels = codes(width, height);
    for (const bool is_column_wise : {false, true}) {
        for (const char x_sign : {'+', '-'}) {
            for (const char y_sign : {'+', '-'}) {
                std::vector<Code> stored;
                const std::size_t lines = is_column_wise ? width : height;
                const std::size_t across = width + height - lines;
                for (std::size_t i = 0; i < lines * across; ++i) {
                    std::size_t x = i % across, y = i / across;
                    if (is_column_wise) std::swap(x, y);
                    if (x_sign == '-') x = width - 1 - x;
                    if (y_sign == '+') y = height - 1 - y;
                    stored.push_back(pixels[y * width + x]);
                }
                const std::string along_x = std::string(1, x_sign) + "X 9";
                const std::string along_y = std::string(1, y_sign) + "Y 10";
                const std::string size =
                    is_column_wise ? along_x + " " + along_y : along_y + " " + along_x;
                SCOPED_TRACE(size);
                const std::string start = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
                expect_decodes(start + flat(stored), pixels);
                expect_decodes(start + old_runs(stored, across), pixels);
                expect_decodes(start + new_runs(stored, across), pixels);
            }
        }
    }
}

TEST(Hdr, OtherSizeLinesAndFormatsAreRefusedWithTheirText) {
    const auto refused = [](const std::string& bytes) {
        return refusal(decode_hdr(as_bytes(bytes), "x.hdr"));
    };
    EXPECT_THAT(refused("#?RADIANCE\n\n+Y 1 +Y 1\nabcd"), HasSubstr("+Y 1 +Y 1"));
    EXPECT_THAT(refused("#?RADIANCE\n\n-Y 1 *X 1\nabcd"), HasSubstr("expected '-Y height"));
    EXPECT_THAT(refused("#?RADIANCE\n\n-Y 1\nabcd"), HasSubstr("-Y 1"));
    EXPECT_THAT(refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd"),
                HasSubstr("32-bit_rle_xyze"));
    EXPECT_THAT(refused("#?RADIANCE\n\n-Y 9999999 +X 9999999\nabcd"), HasSubstr("claims"));
    EXPECT_THAT(refused("#?RADIANCE\nEXPOSURE=nan\n\n-Y 1 +X 1\nabcd"), HasSubstr("EXPOSURE"));
    EXPECT_THAT(refused("no picture"), HasSubstr("is not a Radiance picture"));
}

TEST(Hdr, RunsThatPassTheEndOfARowAreRefused) {
    const auto fails = [](const std::string& pixels) {
        return !decode_hdr(as_bytes(head(8, 1) + pixels), "x.hdr");
    };
    using namespace std::string_literals;
    EXPECT_TRUE(fails("\x01\x01\x01\x05"s));                          // nothing to repeat
    EXPECT_TRUE(fails("\x09\x09\x09\x80\x01\x01\x01\x08"s));          // one pixel + 8 > 8
    EXPECT_TRUE(fails("\x02\x02\x00\x08\x89\x01"s));                  // a run of 9 in a row of 8
    EXPECT_TRUE(fails("\x02\x02\x00\x08\x00\x00\x00\x00\x00\x00"s));  // a run of nothing
    EXPECT_TRUE(fails("\x02\x02\x00\x09\x88\x01\x88\x01\x88\x01\x88\x01"s));  // wrong width
    EXPECT_FALSE(fails("\x02\x02\x00\x08\x88\x01\x88\x01\x88\x01\x88\x01"s));
}

}  // namespace
}  // namespace opaline::formats
