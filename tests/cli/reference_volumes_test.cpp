#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "formats/image/exr.h"
#include "tests/cli/small_scene.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// The mean of a picture's pixels.
double mean_of(const std::string& path) {
    const auto picture = formats::read_exr(path);
    EXPECT_TRUE(picture) << path;
    double sum = 0;
    for (const formats::Rgb& pixel : picture->pixel) {
        sum += formats::luminance(pixel) / static_cast<double>(picture->pixel.size());
    }
    return sum;
}

TEST(Reference, VolumesBesideMeshesAndAlone) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string();
    for (const char* name : {"smoke", "cumulus"}) {
        ASSERT_EQ(run_opaline({"example", name, "-o", folder.path().string()}).exit_code, 0);
    }
    const auto look = [&](const char* scene, const char* terms) {
        const Outcome outcome =
            run_opaline({"reference", (folder / scene).string(), "--light", "white", "--size",
                         "24x24", "--spp", "32", "--terms", terms, "-o", out});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return mean_of(out);
    };
    // Under even light a cloud that absorbs nothing is as bright as the sky: here, a share of the
    // picture.
    const double cloud = look("cumulus.json", "volume-single,volume-multiple");
    EXPECT_GT(cloud, 0.02);
    EXPECT_LT(cloud, 0.5);
    EXPECT_NEAR(look("cumulus.json", "all"), 1, 0.02);
    // Without the media file it is a denser cloud of another colour.
    EXPECT_GT(look("cumulus.vdb", "volume-multiple"), 0.02);
    EXPECT_GT(look("smoke.gltf", "volume-single"), 1e-4);
    EXPECT_GT(look("smoke.gltf", "diffuse"), 0.02);
}

TEST(Reference, WhatNeedsSurfacesSaysSoOfVolumes) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_opaline({"example", "cumulus", "-o", folder.path().string()}).exit_code, 0);
    const std::string scene = (folder / "cumulus.json").string();
    const auto before = list_folder(folder.path());
    const Outcome table = run_opaline({"reference", scene, "--light", "white", "--receivers", "5",
                                       "-o", (folder / "out.csv").string()});
    EXPECT_EQ(table.exit_code, 2);
    EXPECT_THAT(table.err, HasSubstr("no vertices"));
    const Outcome twice = run_opaline({"reference", scene, "--media", scene, "--light", "white",
                                       "-o", (folder / "out.exr").string()});
    EXPECT_EQ(twice.exit_code, 2);
    EXPECT_EQ(list_folder(folder.path()), before);
}

TEST(Reference, PathIntegrationDrawsVolumesWithoutNoise) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string(), again = (folder / "again.exr").string();
    ASSERT_EQ(run_opaline({"example", "milk", "-o", folder.path().string()}).exit_code, 0);
    const auto draw = [&](const std::string& file, const char* threads) {
        const Outcome outcome =
            run_opaline({"reference", (folder / "milk.json").string(), "--light", "sun:60,35",
                         "--method", "path-integration", "--renormalise", "off", "--size", "16x12",
                         "--threads", threads, "-o", file});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("path integration, 4 rays for each of 192 pixels"));
    };
    draw(out, "1");
    draw(again, "2");
    EXPECT_EQ(read_text(out), read_text(again));
    EXPECT_GT(mean_of(out), 0.01);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.var.exr"));
}

TEST(Reference, PaperFidelityIsForPicturesByPathIntegrationAlone) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_opaline({"example", "milk", "-o", folder.path().string()}).exit_code, 0);
    const std::string paper = (folder / "paper.json").string();
    std::ofstream(paper) << R"({"volumes": [{"file": "milk.vdb", "sigma_t": [7, 12, 19],
                                               "fidelity": "paper"}]})";
    const Arguments picture = {"reference", paper,   "--light",  "sun:60,35",
                               "--size",    "16x12", "--method", "path-integration"};
    const auto draw = [&](const Arguments& more) {
        Arguments arguments = picture;
        arguments.insert(arguments.end(), {"-o", (folder / "out.exr").string()});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_opaline(arguments);
    };
    EXPECT_EQ(draw({"--renormalise", "on"}).exit_code, 2);
    const Outcome drawn = draw({});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.err, AllOf(HasSubstr("as printed"), HasSubstr("with fidelity paper")));
    EXPECT_GT(mean_of((folder / "out.exr").string()), 0.01);
    for (const char* command : {"bake", "plan"}) {
        Arguments arguments = {command, paper};
        if (command == std::string_view("bake")) {
            arguments.insert(arguments.end(), {"-o", (folder / "out.opal").string()});
        }
        const Outcome refused = run_opaline(arguments);
        EXPECT_EQ(refused.exit_code, 3) << command;
        EXPECT_THAT(refused.err, HasSubstr("reference --method path-integration")) << command;
    }
}

TEST(Reference, PathIntegrationRefusesWhatItCannotDo) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_opaline({"example", "milk", "-o", folder.path().string()}).exit_code, 0);
    const std::string milk = (folder / "milk.json").string();
    const auto try_with = [&](const std::string& scene, Arguments more) {
        Arguments arguments = {"reference", scene, "--light",
                               "white",     "-o",  (folder / "out.exr").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_opaline(arguments);
    };
    const Arguments paths = {"--method", "path-integration"};
    for (const Arguments& option : {Arguments{"--seconds", "3"},
                                    {"--max-depth", "2"},
                                    {"--texture-filter", "limited"},
                                    {"--seed", "5"}}) {
        Arguments more = paths;
        more.insert(more.end(), option.begin(), option.end());
        const Outcome outcome = try_with(milk, more);
        EXPECT_EQ(outcome.exit_code, 2) << option[0];
        EXPECT_THAT(outcome.err, HasSubstr(option[0]));
    }
    const Outcome terms =
        try_with(milk, {"--method", "path-integration", "--terms", "interreflection"});
    EXPECT_EQ(terms.exit_code, 2);
    EXPECT_THAT(terms.err, HasSubstr("volume-single"));
    EXPECT_EQ(try_with(milk, {"--renormalise", "on"}).exit_code, 2);
    EXPECT_EQ(try_with(milk, {"--method", "guess"}).exit_code, 2);
    SmallScene small;
    const Outcome meshes = try_with(small.scene(), paths);
    EXPECT_EQ(meshes.exit_code, 3);
    EXPECT_THAT(meshes.err, HasSubstr("leave out --method"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace opaline::tests
