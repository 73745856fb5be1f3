// --simplify: who shares rows is said by plan, report and info.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A square of two triangles with three vertices each.
Blob unwelded_square() {
    AssetBuilder asset;
    const auto positions =
        asset.add<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1}, "VEC3");
    std::vector<float> up;
    for (int v = 0; v < 6; ++v) {
        up.insert(up.end(), {0, 1, 0});
    }
    const auto normals = asset.add<float>(up, "VEC3");
    asset.add_node(asset.add_mesh({{"POSITION", positions}, {"NORMAL", normals}}));
    return asset.glb();
}

TEST(Simplify, SharedRowsAreSaidByPlanReportAndInfo) {
    const TemporaryFolder folder;
    const std::string scene = folder / "square.glb", file = folder / "a.opal";
    write_file(scene, unwelded_square());
    const auto slots_with = [&](const char* simplify) {
        const Arguments options{"--quality", "draft", "--refine", "off", "--simplify", simplify};
        const Json plan = Json::parse(run_well(join({"plan", scene, "--json"}, options)).out);
        run_well(join({"bake", scene, "-o", file, "--report", folder / "r.json"}, options));
        const Json report = Json::parse(read_text(folder / "r.json")).at("output");
        const Json info = Json::parse(run_well({"info", file, "--json"}).out);
        for (const Json& said : {plan, report, info}) {
            EXPECT_EQ(said.at("receivers"), 6);
            EXPECT_EQ(said.at("slots"), plan.at("slots"));
        }
        EXPECT_EQ(report.at("rows"), info.at("rows"));
        return info.at("slots").get<int>();
    };
    EXPECT_EQ(slots_with("off"), 6);
    EXPECT_THAT(run_well({"info", file}).out, Not(HasSubstr("share")));
    EXPECT_EQ(slots_with("auto"), 4);
    EXPECT_THAT(run_well({"info", file}).out, HasSubstr("6 vertices share the rows of 4"));
    EXPECT_THAT(run_well({"plan", scene, "--refine", "off"}).out,
                HasSubstr("6 receivers that share the rows of 4"));
}

TEST(Simplify, OtherWordsAreRefused) {
    const TemporaryFolder folder;
    write_file(folder / "square.glb", unwelded_square());
    const Outcome outcome =
        start_opaline({"bake", folder / "square.glb", "-o", folder / "a.opal", "--simplify", "on"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("--simplify"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.opal"));
}

}  // namespace
}  // namespace opaline::tests
