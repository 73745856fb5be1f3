#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/cli/small_scene.h"
#include "tests/support/scenes.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Reference, VolumesBesideMeshesAndAlone) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string();
    for (const char* name : {"smoke", "cumulus"}) {
        run_well({"example", name, "-o", folder.path().string()});
    }
    const auto look = [&](const char* scene, const char* terms) {
        run_well({"reference", (folder / scene).string(), "--light", "white", "--size", "24x24",
                  "--spp", "32", "--terms", terms, "-o", out});
        return mean_of_picture(out);
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
    run_well({"example", "cumulus", "-o", folder.path().string()});
    const std::string scene = (folder / "cumulus.json").string();
    const auto before = list_folder(folder.path());
    expect_refused({"reference", scene, "--light", "white", "--receivers", "5", "-o",
                    (folder / "out.csv").string()},
                   2, "no vertices");
    expect_refused({"reference", scene, "--media", scene, "--light", "white", "-o",
                    (folder / "out.exr").string()},
                   2, "");
    EXPECT_EQ(list_folder(folder.path()), before);
}

TEST(Reference, PathIntegrationDrawsVolumesWithoutNoise) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.exr").string(), again = (folder / "again.exr").string();
    run_well({"example", "milk", "-o", folder.path().string()});
    const auto draw = [&](const std::string& file, const char* threads) {
        const Outcome outcome =
            run_well({"reference", (folder / "milk.json").string(), "--light", "sun:60,35",
                      "--method", "path-integration", "--renormalise", "off", "--size", "16x12",
                      "--threads", threads, "-o", file});
        EXPECT_THAT(outcome.err, HasSubstr("path integration, 4 rays for each of 192 pixels"));
    };
    draw(out, "1");
    draw(again, "2");
    EXPECT_EQ(read_text(out), read_text(again));
    EXPECT_GT(mean_of_picture(out), 0.01);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.var.exr"));
}

TEST(Reference, PaperFidelityIsForPicturesByPathIntegrationAlone) {
    const TemporaryFolder folder;
    run_well({"example", "milk", "-o", folder.path().string()});
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
    EXPECT_GT(mean_of_picture((folder / "out.exr").string()), 0.01);
    for (const char* command : {"bake", "plan"}) {
        Arguments arguments = {command, paper};
        if (command == std::string_view("bake")) {
            arguments.insert(arguments.end(), {"-o", (folder / "out.opal").string()});
        }
        expect_refused(arguments, 3, "reference --method path-integration");
    }
}

TEST(Reference, PathIntegrationRefusesWhatItCannotDo) {
    const TemporaryFolder folder;
    run_well({"example", "milk", "-o", folder.path().string()});
    const std::string milk = (folder / "milk.json").string();
    SmallScene small;
    const struct {
        std::string scene;
        Arguments more;
        int exit_code;
        const char* says;
    } cases[] = {{milk, {"--seconds", "3"}, 2, "--seconds"},
                 {milk, {"--max-depth", "2"}, 2, "--max-depth"},
                 {milk, {"--texture-filter", "limited"}, 2, "--texture-filter"},
                 {milk, {"--seed", "5"}, 2, "--seed"},
                 {milk, {"--terms", "interreflection"}, 2, "volume-single"},
                 {small.scene(), {}, 3, "leave out --method"}};
    const Arguments output = {"--light", "white", "-o", (folder / "out.exr").string()};
    for (const auto& [scene, more, exit_code, says] : cases) {
        expect_refused(
            join(join({"reference", scene, "--method", "path-integration"}, output), more),
            exit_code, says);
    }
    expect_refused(join({"reference", milk, "--renormalise", "on"}, output), 2, "--renormalise");
    expect_refused(join({"reference", milk, "--method", "guess"}, output), 2, "--method");
    EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace opaline::tests
