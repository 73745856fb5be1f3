// The exposure of `render` where none is given.
#include <gmock/gmock.h>

#include "formats/image/exr.h"
#include "formats/image/png.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

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
