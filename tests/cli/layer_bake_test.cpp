#include <gmock/gmock.h>

#include <string>

#include "tests/cli/print_json.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A media file of a layer alone, of droplets so small that its bake takes a second.
std::string write_layer_scene(const SmallScene& small, const std::string& more) {
    const std::string path = small.path("layer.json");
    write_file(path,
               std::string(R"({"clouds": [{"r_e": 2e-6, "size": [4000, 4000], )" + more + "}]}"));
    return path;
}

nlohmann::json plan_of(const std::string& scene, const std::string& effect) {
    const nlohmann::json plan = print_json("plan", {scene, "--json"});
    for (const nlohmann::json& entry : plan["plan"]) {
        if (entry["effect"] == effect) return entry;
    }
    ADD_FAILURE() << "no " << effect << " in the plan of " << scene;
    return {};
}

TEST(LayerBake, IsPlannedBakedAndStatedFromAMediaFileAlone) {
    SmallScene small;
    const std::string scene = write_layer_scene(small, R"("thickness": 300)");
    EXPECT_EQ(plan_of(scene, "cloud")["decision"], "on");
    EXPECT_EQ(plan_of(scene, "cloud.multiple")["decision"], "on");
    EXPECT_EQ(plan_of(scene, "radiosity")["decision"], "on");
    const std::string file = small.path("layer.opal"), report = small.path("report.json");
    const Outcome bake =
        run_well({"bake", scene, "-o", file, "--quality", "draft", "--report", report});
    EXPECT_THAT(bake.err, HasSubstr("cloud layer errs by"));
    const nlohmann::json error = nlohmann::json::parse(read_text(report))["error"];
    const double stated = error["by_effect"]["cloud"];
    EXPECT_GT(stated, 0);
    EXPECT_LT(stated, 0.1);
    EXPECT_EQ(error["rms_relative"], stated);
    EXPECT_THAT(run_opaline({"info", file}).out,
                AllOf(HasSubstr("layer errs"), HasSubstr("base at 1000 m over ground at 0 m"),
                      Not(HasSubstr("measured error"))));
    run_well({"verify", file});
}

}  // namespace
}  // namespace opaline::tests
