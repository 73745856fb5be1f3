// The camera of `render`: what its options mean, and which contradict each other.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

Arguments drawing_of(const SmallScene& small, const std::string& file, const Arguments& options,
                     const std::string& name) {
    return join({"render", file, "--light", "white", "--size", "40x30", "-o", small.path(name),
                 "--backend", "cpu"},
                options);
}

TEST(RenderCamera, AnglesAndDistancePlaceTheEyeAroundTheTarget) {
    SmallScene small;
    const std::string file = small.baked();
    // 30 degrees up at 2 m: 1 m above; azimuth 90 is +X.
    run_well(
        drawing_of(small, file,
                   {"--target", "0,0,0", "--azimuth", "90", "--elevation", "30", "--distance", "2"},
                   "angles.exr"));
    run_well(drawing_of(small, file, {"--target", "0,0,0", "--eye", "1.7320508,1,0"}, "eye.exr"));
    run_well({"compare", small.path("angles.exr"), small.path("eye.exr"), "--max-rel", "1e-4"});
    run_well(drawing_of(small, file, {"--azimuth", "100"}, "aside.exr"));
    EXPECT_EQ(run_opaline({"compare", small.path("angles.exr"), small.path("aside.exr"),
                           "--max-rel", "1e-4"})
                  .exit_code,
              1);
}

TEST(RenderCamera, EyeAndAnglesContradictEachOther) {
    SmallScene small;
    const std::string file = small.baked();
    for (const std::string option : {"--azimuth", "--elevation", "--distance"}) {
        expect_refused(drawing_of(small, file, {"--eye", "0,0,3", option, "2"}, "x.png"), 2,
                       "--eye cannot be given with " + option);
    }
}

// Upside down is the picture turned by half a turn, so its rows and columns run backward.
TEST(RenderCamera, UpTurnsThePicture) {
    SmallScene small;
    const std::string file = small.baked();
    const Arguments eye{"--eye", "0,3,4", "--target", "0,0,0"};
    const auto with = [&](const std::string& up) { return join(eye, {"--up", up}); };
    run_well(drawing_of(small, file, eye, "plain.exr"));
    run_well(drawing_of(small, file, with("0,2,0"), "same.exr"));
    run_well(drawing_of(small, file, with("0,-1,0"), "turned.exr"));
    EXPECT_EQ(read_text(small.path("plain.exr")), read_text(small.path("same.exr")));
    const auto plain = formats::read_exr(small.path("plain.exr"));
    auto turned = formats::read_exr(small.path("turned.exr"));
    ASSERT_TRUE(plain && turned);
    EXPECT_NE(plain->pixel, turned->pixel);
    std::ranges::reverse(turned->pixel);
    double sum = 0;
    for (std::size_t i = 0; i < plain->pixel.size(); ++i) {
        sum += std::abs(plain->pixel[i].g - turned->pixel[i].g);
    }
    EXPECT_LT(sum / double(plain->pixel.size()), 1e-3) << "samples at edges may differ";
    expect_refused(drawing_of(small, file, with("0,0,0"), "x.exr"), 2, "");
}

TEST(Render, FewerCoefficientsDrawWhatABakeWithFewerLooksLike) {
    SmallScene small;
    run_well({"bake", small.scene(), "-o", small.path("many.opal"), "--refine", "off",
              "--coefficients", "200", "--seed", "1"});
    run_well({"bake", small.scene(), "-o", small.path("few.opal"), "--refine", "off",
              "--coefficients", "20", "--seed", "1"});
    run_well(drawing_of(small, small.path("many.opal"), {}, "many.exr"));
    run_well(drawing_of(small, small.path("few.opal"), {}, "few.exr"));
    run_well(drawing_of(small, small.path("many.opal"), {"--coefficients", "20"}, "cut.exr"));
    // Codes of the many have coarser steps than those of the few at most: 1/127 of the largest.
    run_well({"compare", small.path("cut.exr"), small.path("few.exr"), "--max-rel", "2e-3"});
    EXPECT_EQ(
        run_opaline({"compare", small.path("many.exr"), small.path("few.exr"), "--max-rel", "2e-3"})
            .exit_code,
        1);
    expect_refused(drawing_of(small, small.path("many.opal"), {"--coefficients", "5"}, "x.exr"), 2,
                   "");
}

}  // namespace
}  // namespace opaline::tests
