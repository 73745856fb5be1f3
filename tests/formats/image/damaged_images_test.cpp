#include <gtest/gtest.h>

#include <algorithm>

#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "formats/image/load_environment.h"
#include "formats/image/png.h"
#include "tests/formats/image/image_files.h"

namespace opaline::formats {
namespace {

std::string small_hdr() {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int row = 0; row < 4; ++row) {
        bytes += {2, 2, 0, 8};
        for (int component = 0; component < 4; ++component) {
            bytes += {static_cast<char>(-124), static_cast<char>(100 + component), 4, 1, 2, 3, 4};
        }
    }
    return bytes;
}

std::string small_png() {
    const auto path = temporary("damage.png");
    Image8 image{5, 4, std::vector<std::uint8_t>(80, 77)};
    EXPECT_TRUE(write_png(path, image));
    std::string bytes = read_bytes(path);
    std::filesystem::remove(path);
    return bytes;
}

// A decoder must return; a loaded environment must be usable.
void decode_all(const std::string& bytes) {
    // An exact-size heap copy, so that an address sanitizer sees a read past the end.
    const std::vector<std::byte> exact(as_bytes(bytes).begin(), as_bytes(bytes).end());
    (void)decode_exr(exact, "x");
    (void)decode_hdr(exact, "x");
    (void)decode_png(exact, "x");
    const Result<LoadedEnvironment> loaded = decode_environment(exact, "x");
    if (!loaded) {
        EXPECT_FALSE(loaded.error().diagnostics.empty());
        return;
    }
    for (const Rgb& c : loaded->environment.pixel) {
        for (const float v : {c.r, c.g, c.b}) {
            ASSERT_TRUE(v >= 0 && v <= kMaxRadiance);
        }
    }
}

std::vector<std::string> small_files() {
    std::vector<std::string> files{small_hdr(), small_png()};
    for (const int compression : {0, 1, 3, 4, 5, 7, 9}) {
        files.push_back(make_exr(ramp(12, 6), {.compression = compression, .is_half = true}));
    }
    files.push_back(make_exr(ramp(24, 20), {.is_tiled = true}));
    files.push_back(make_exr_of_parts(ramp(4, 3)));
    files.push_back(make_exr(ramp(3, 18), {.is_grey = true, .envmap = Envmap::cube}));
    return files;
}

TEST(DamagedImages, EveryPrefixIsRefusedOrHarmless) {
    for (const std::string& file : small_files()) {
        // Headers end anywhere; of pixels every seventh byte.
        for (std::size_t length = 0; length < file.size(); length += length < 400 ? 1 : 7) {
            decode_all(file.substr(0, length));
        }
    }
    // Every byte of these carries the image; a tiled file ends with smaller levels, not looked at.
    const std::string exr = make_exr(ramp(12, 6), {});
    EXPECT_FALSE(decode_exr(as_bytes(exr.substr(0, exr.size() - 1)), "x"));
    const std::string hdr = small_hdr();
    EXPECT_FALSE(decode_hdr(as_bytes(hdr.substr(0, hdr.size() - 1)), "x"));
}

TEST(DamagedImages, FlippedBitsAreRefusedOrHarmless) {
    for (const std::string& file : small_files()) {
        for (std::size_t bit = 0; bit < 8 * file.size(); bit += 53) {  // all eight in turn
            std::string damaged = file;
            damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
            decode_all(damaged);
        }
    }
}

TEST(DamagedImages, BytesSetToExtremesAreRefusedOrHarmless) {
    for (const std::string& file : small_files()) {
        for (std::size_t at = 0; at < file.size(); at += 5) {
            for (const char value : {'\x00', '\x7f', '\xff'}) {
                std::string damaged = file;
                for (std::size_t i = at; i < std::min(at + 4, file.size()); ++i) {
                    damaged[i] = value;
                }
                decode_all(damaged);
            }
        }
    }
}

}  // namespace
}  // namespace opaline::formats
