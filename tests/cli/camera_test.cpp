// The camera of `render`: what its options mean, and which contradict each other.
// The exposure of `render` where none is given.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "formats/image/exr.h"
#include "formats/image/png.h"
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

using ::testing::HasSubstr;
using ::testing::Not;

// Two squares under a sun of 1366 lux, as exporters write one of 2 W/m2.
std::string bake_sunlit(const SmallScene& small) {
    AssetBuilder asset = two_squares();
    asset.json["extensionsUsed"] = {"KHR_lights_punctual"};
    asset.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "directional"}, {"name", "Sun"}, {"intensity", 1366}}});
    asset.json["nodes"].push_back({{"rotation", {-0.7071068, 0, 0, 0.7071068}},
                                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    asset.json["scenes"][0]["nodes"].push_back(asset.json["nodes"].size() - 1);
    write_file(small.path("sun.glb"), asset.glb());
    run_well({"bake", small.path("sun.glb"), "-o", small.path("sun.opal"), "--quality", "draft"});
    return small.path("sun.opal");
}

// Mean of the middle ninth of a picture, 0 to 1.
double middle_grey(const std::string& path) {
    const auto image = formats::read_png(path);
    EXPECT_TRUE(image) << path;
    double sum = 0, count = 0;
    for (std::uint32_t y = image->height / 3; y < 2 * image->height / 3; ++y) {
        for (std::uint32_t x = image->width / 3; x < 2 * image->width / 3; ++x) {
            sum += image->rgba[4 * (std::size_t{y} * image->width + x) + 1] / 255.0;
            ++count;
        }
    }
    return sum / count;
}

TEST(Exposure, ASunInLuxIsNoWhitePictureAndAllFramesShareOneExposure) {
    SmallScene small;
    const std::string file = bake_sunlit(small);
    const auto draw = [&](const std::string& name, Arguments more) {
        const Outcome outcome =
            run_well(join({"render", file, "--size", "48x36", "-o", small.path(name)}, more));
        return outcome.err;
    };
    for (const std::string backend : {"cpu", "gl"}) {
        const std::string note = draw("a.png", {"--frames", "3", "--backend", backend});
        EXPECT_THAT(note, HasSubstr("EV; --exposure sets it")) << backend;
        EXPECT_EQ(note.find("exposure -"), note.rfind("exposure -")) << "once";
        EXPECT_GT(middle_grey(small.path("a-0001.png")), 0.15) << backend;
        EXPECT_LT(middle_grey(small.path("a-0001.png")), 0.85) << backend;
    }
    // What is given is taken, and radiance is data.
    EXPECT_THAT(draw("b.png", {"--exposure", "0"}), Not(HasSubstr("exposure")));
    EXPECT_GT(middle_grey(small.path("b.png")), 0.9);
    EXPECT_THAT(draw("c.exr", {}), Not(HasSubstr("exposure")));
    const auto radiance = formats::read_exr(small.path("c.exr"));
    ASSERT_TRUE(radiance);
    EXPECT_GT(radiance->pixel[48 * 18 + 24].g, 50);
}

TEST(Exposure, PathTracingsPictureOfASunInLuxIsExposedAsTheBakesIs) {
    SmallScene small;
    const std::string file = bake_sunlit(small);
    const auto exposure_of = [](const std::string& note) {
        const std::string before = "exposure ";
        return std::stod(note.substr(note.find(before) + before.size()));
    };
    const Arguments picture{"--light", "studio", "--size", "48x36", "-o", small.path("a.png")};
    const double baked = exposure_of(run_well(join({"render", file}, picture)).err);
    const double traced = exposure_of(
        run_well(join({"reference", small.path("sun.glb"), "--spp", "4"}, picture)).err);
    EXPECT_NEAR(traced, baked, 0.3);
}

TEST(Exposure, PlanAndInfoSayByHowMuchALampOutshinesTheSky) {
    SmallScene small;
    const std::string file = bake_sunlit(small);
    EXPECT_THAT(run_opaline({"plan", small.path("sun.glb")}).out,
                HasSubstr("109 times that of a sky of radiance 1"));  // 1366 / (4 pi)
    const Json info = Json::parse(run_opaline({"info", file, "--json"}).out);
    // 1366 / pi on what faces it, under a sky that is partly hidden.
    EXPECT_NEAR(info["emitters"][0]["times_white_sky"].get<double>(), 435, 90);
}

}  // namespace

}  // namespace opaline::tests
