#include <gmock/gmock.h>

#include <limits>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class BadLight : public ::testing::Test {
  protected:
    Outcome relight(const std::string& light) {
        return run_opaline({"relight", small_.baked(), "--light", light, "-o", out()});
    }
    std::string refuse(const std::string& light, int exit_code = 3) {
        const Outcome outcome = relight(light);
        EXPECT_EQ(outcome.exit_code, exit_code) << light << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: "));
        EXPECT_FALSE(std::filesystem::exists(out()));
        return outcome.err;
    }
    std::string out() const { return small_.path("out.csv"); }
    /// A map of 8 x 4 texels of radiance 1, but for the texel in the middle of the sky.
    std::string write_map(Rgb odd) {
        formats::Image image{8, 4, std::vector<Rgb>(32, Rgb{1, 1, 1})};
        image.pixel[4] = odd;
        const std::string path = small_.path("map.exr");
        EXPECT_TRUE(formats::write_exr(path, image));
        return path;
    }
    SmallScene small_;
};

TEST_F(BadLight, FileThatIsNoExrIsRefusedWhateverItsName) {
    write_file(small_.path("fake.exr"), std::string("PNG? no. EXR? no."));
    EXPECT_THAT(refuse(small_.path("fake.exr")), HasSubstr("fake.exr"));
    write_file(small_.path("empty.exr"), std::string());
    refuse(small_.path("empty.exr"));
    refuse(small_.path("nowhere.exr"));
}

TEST_F(BadLight, TexelsThatAreNoNumbersOrNegativeBecomeBlackWithAWarning) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    ASSERT_EQ(relight(write_map({0, 0, 0})).exit_code, 0);
    const std::string black = read_text(out());
    for (const Rgb& odd : {Rgb{nan, nan, nan}, Rgb{-3, -3, -3}}) {
        const Outcome outcome = relight(write_map(odd));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, StartsWith("opaline: warning: "));
        EXPECT_EQ(read_text(out()), black);
    }
    EXPECT_EQ(relight(write_map({inf, inf, inf})).exit_code, 0);
    EXPECT_THAT(read_text(out()), ::testing::Not(::testing::ContainsRegex("inf|nan")));
}

}  // namespace
}  // namespace opaline::tests
