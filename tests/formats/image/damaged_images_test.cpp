#include <gtest/gtest.h>

#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "tests/formats/image/image_files.h"

namespace opaline::formats {
namespace {

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
