// Files that hold a cloud layer and no vertex, as users meet them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/print_json.h"
#include "tests/cli/small_scene.h"
#include "tests/formats/opal/cloud_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(CloudFiles, InfoListsTheLayer) {
    SmallScene small;
    const formats::Asset asset = make_cloud_asset();
    const std::string file = small.write(asset, "clouds.opal");
    const Outcome text = run_well({"info", file});
    EXPECT_THAT(text.out,
                AllOf(HasSubstr("cloud layers\n    0  base at 800 m over ground at -20 m, "
                                "4000 x 3000 m, up to "),
                      HasSubstr("orders: 0, 1, and 2 or more"), HasSubstr("CLOU"),
                      Not(HasSubstr("primitives"))));
    const nlohmann::json info = print_json("info", {file, "--json"});
    ASSERT_EQ(info["layers"].size(), 1u);
    const nlohmann::json& layer = info["layers"][0];
    EXPECT_EQ(layer["base"], 800);
    EXPECT_EQ(layer["ground"], -20);
    EXPECT_EQ(layer["size"], nlohmann::json({4000, 3000}));
    EXPECT_EQ(layer["wind"], nlohmann::json({5, -2.5}));
    EXPECT_GT(layer["largest_thickness"], 125);
    EXPECT_LE(layer["largest_thickness"], 250);
    EXPECT_EQ(layer["kappa"][2], 0.046f);
    EXPECT_EQ(layer["multiple_scattering"], true);
    EXPECT_EQ(layer["repeats"], false);
    EXPECT_EQ(layer["fidelity"], "physical");
    EXPECT_THAT(text.out, Not(HasSubstr("fidelity")));
    EXPECT_EQ(layer["tables"]["flux"], nlohmann::json({4, 3}));
    EXPECT_EQ(layer["tables"]["radiance"], nlohmann::json({2, 3, 2}));
    EXPECT_EQ(layer["bytes"],
              176 + 2 * asset.clouds.thickness.size() + 4 * 6 + 4 * asset.clouds.value.size());
    EXPECT_TRUE(info["volumes"].empty() && info["primitives"].empty());

    formats::Asset paper = asset;
    paper.clouds.records[0].flags |= formats::LayerRecord::kPaper;
    EXPECT_THAT(run_opaline({"info", small.write(paper, "clouds.opal")}).out,
                HasSubstr("; fidelity paper\n"));

    const formats::Asset single = make_cloud_asset({.has_radiance = false});
    EXPECT_THAT(run_opaline({"info", small.write(single, "clouds.opal")}).out,
                HasSubstr("orders: 0 and 1;"));
}

TEST(CloudFiles, VerifyAcceptsSoundOnesAndNamesFaults) {
    SmallScene small;
    formats::Asset asset = make_cloud_asset();
    run_well({"verify", small.write(asset, "clouds.opal")});
    asset.clouds.value.back() = 1e30f;
    expect_refused({"verify", small.write(asset, "clouds.opal")}, 1,
                   "section CLOU, layer 0: band 2: a value of its tables of radiance");
}

}  // namespace
}  // namespace opaline::tests
