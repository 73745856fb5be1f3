#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/small_scene.h"
#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(VolumeFiles, RelightWritesATableOfReceiversAndOneOfNodes) {
    SmallScene small;
    const formats::Asset asset = make_volume_asset();
    const std::string file = small.write(asset, "smoke.opal");
    const std::string out = small.path("o.csv"), volumes = small.path("o-volumes.csv");
    const Outcome mean = run_well({"relight", file, "--light", "studio", "--json", "-o", out});
    EXPECT_EQ(read_text(out), "primitive,vertex,r,g,b\n");
    EXPECT_THAT(mean.err, HasSubstr("o-volumes.csv has the nodes"));
    EXPECT_THAT(read_text(volumes), StartsWith("volume,i,j,k,r,g,b\n0,"));
    EXPECT_EQ(count_lines(volumes), asset.volumes.node.size() + 1);
    EXPECT_EQ(nlohmann::json::parse(mean.out)["volume_nodes"], asset.volumes.node.size());

    const std::string seen = small.path("seen.csv");
    run_well({"relight", file, "--light", "studio", "--eye", "3,2,1", "-o", seen});
    EXPECT_NE(read_text(small.path("seen-volumes.csv")), read_text(volumes));
}

TEST(VolumeFiles, TermsOfVolumesAreShownApart) {
    SmallScene small;
    const std::string file = small.write(make_volume_asset(), "smoke.opal");
    for (const char* terms : {"volume-single", "volume-multiple", "diffuse"}) {
        run_well({"relight", file, "--light", "white", "--terms", terms, "-o",
                  small.path(terms + std::string(".csv"))});
    }
    const std::string single = read_text(small.path("volume-single-volumes.csv"));
    EXPECT_NE(single, read_text(small.path("volume-multiple-volumes.csv")));
    EXPECT_NE(single, read_text(small.path("diffuse-volumes.csv")));
}

TEST(VolumeFiles, OtherTablesSayThatVolumesAreMissing) {
    SmallScene small;
    formats::Asset asset = make_small_asset();
    add_volume(asset, {});
    const std::string file = small.write(asset, "smoke.opal");
    const Outcome outcome =
        run_well({"relight", file, "--light", "white", "-o", small.path("o.ply")});
    EXPECT_THAT(outcome.err, HasSubstr("only .csv"));
}

TEST(VolumeFiles, TheTableOfNodesDoesNotTakeTheOthersPlace) {
    SmallScene small;
    const std::string file = small.write(make_volume_asset(), "smoke.opal");
    std::filesystem::create_symlink(small.path("o.csv"), small.path("o-volumes.csv"));
    expect_refused({"relight", file, "--light", "white", "-o", small.path("o.csv")}, 2,
                   "the table of volumes");
}

TEST(VolumeFiles, InfoListsThem) {
    SmallScene small;
    const formats::Asset asset = make_volume_asset();
    const std::string file = small.write(asset, "smoke.opal");
    const Outcome text = run_well({"info", file});
    EXPECT_THAT(text.out, HasSubstr("active voxels"));
    const auto info = nlohmann::json::parse(run_opaline({"info", file, "--json"}).out);
    ASSERT_EQ(info["volumes"].size(), asset.volumes.records.size());
    for (std::size_t v = 0; v < asset.volumes.records.size(); ++v) {
        const formats::VolumeRecord& record = asset.volumes.records[v];
        const auto& entry = info["volumes"][v];
        EXPECT_EQ(entry["bricks"], record.brick_count);
        EXPECT_EQ(entry["nodes"], record.node_count);
        EXPECT_EQ(entry["spacing"], record.spacing);
        EXPECT_EQ(entry["single_terms"], record.single_terms);
        EXPECT_EQ(entry["multiple_terms"], record.multiple_terms);
        EXPECT_EQ(entry["bands"], record.bands);
        EXPECT_GT(entry["active_voxels"], 500 * record.brick_count);
        EXPECT_GT(entry["bytes_per_active_voxel"], 2);
    }
}

TEST(VolumeFiles, AnExampleIsBakedFromDensityToPicture) {
    const TemporaryFolder folder;
    run_well({"example", "cumulus", "-o", folder.path().string()});
    const std::string scene = (folder / "cumulus.json").string();
    const std::string file = (folder / "c.opal").string(), again = (folder / "d.opal").string();
    const std::string report = (folder / "report.json").string();
    const Outcome bake = run_well({"bake", scene, "-o", file, "--quality", "draft",
                                   "--volume-walks", "8", "--report", report});
    EXPECT_THAT(bake.err, HasSubstr("nodes in volumes"));
    EXPECT_THAT(bake.err, HasSubstr("volumes err by"));
    EXPECT_THAT(run_opaline({"info", file}).out,
                AllOf(HasSubstr("volumes err"), Not(HasSubstr("measured error")),
                      Not(HasSubstr("primitives"))));
    const auto json = nlohmann::json::parse(read_text(report));
    EXPECT_EQ(json["volume_error"]["by_light"].size(), 4u);
    EXPECT_TRUE(json["error"]["not_measured"].empty());
    for (const auto& stage : json["stages"]) {
        const std::string name = stage["name"];
        if (name.ends_with("volumes")) {
            EXPECT_GT(stage["predicted_seconds"], 0) << name;
        }
    }
    ASSERT_EQ(json["plan"].size(), 2u);
    EXPECT_EQ(json["plan"][1]["effect"], "volume-multiple");
    EXPECT_EQ(json["plan"][1]["decision"], "on");
    EXPECT_EQ(json["knobs"]["volume_walks"], 8);

    run_well({"bake", scene, "-o", again, "--quality", "draft", "--volume-walks", "8", "--threads",
              "1"});
    EXPECT_EQ(read_text(file), read_text(again));
    run_well({"verify", file});
    const Outcome asked =
        run_opaline({"bake", scene, "-o", again, "--error", "0.5", "--volume-walks", "8"});
    EXPECT_THAT(asked.err, HasSubstr("asked for 50 %; volumes err by")) << "no receiver";

    // Nothing is absorbed, or nearly: under even light the cloud is as bright as the sky.
    const std::string picture = (folder / "p.exr").string();
    run_well(
        {"render", file, "--light", "white", "--backend", "cpu", "--size", "32x24", "-o", picture});
    EXPECT_NEAR(mean_of_picture(picture), 1, 0.03);
}

TEST(VolumeFiles, SmokeDimsWhatStandsBehindItAndLightsIt) {
    const TemporaryFolder folder;
    run_well({"example", "smoke", "-o", folder.path().string()});
    // The same scene without its volume, which stands in an extension.
    std::string text = read_text((folder / "smoke.gltf").string());
    for (auto at = text.find("OPALINE_media"); at != std::string::npos;
         at = text.find("OPALINE_media")) {
        text.replace(at, 13, "OPALINE_other");
    }
    std::ofstream(folder / "clear.gltf") << text;
    const auto brightness = [&](const char* scene, const char* effects) {
        const std::string file = (folder / "s.opal").string(), out = (folder / "s.csv").string();
        run_well({"bake", (folder / scene).string(), "-o", file, "--quality", "draft",
                  "--volume-walks", "8", "--effects", effects});
        run_well({"relight", file, "--light", "white", "-o", out});
        double sum = 0;
        std::stringstream lines(read_text(out));
        std::string line;
        std::getline(lines, line);
        while (std::getline(lines, line)) {
            sum += std::stod(line.substr(line.rfind(',') + 1));
        }
        return sum;
    };
    const double behind = brightness("smoke.gltf", "direct,multiple");
    const double clear = brightness("clear.gltf", "direct,multiple");
    EXPECT_LT(behind, 0.98 * clear);
    EXPECT_GT(behind, 0.3 * clear);
    // It absorbs a little of what it scatters.
    const double lit =
        brightness("smoke.gltf", "direct,multiple,volume-single,volume-multiple,volume-surface");
    EXPECT_GT(lit, 1.01 * behind);
    EXPECT_LT(lit, clear);
}

}  // namespace
}  // namespace opaline::tests
