// Receivers that a bake adds, as a user asks for them and is told of them.
#include <gmock/gmock.h>

#include "tests/cli/print_json.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

Json bake_report(const SmallScene& small, const Arguments& more) {
    run_well(join({"bake", small.scene(), "-o", small.path("a.opal"), "--quality", "draft",
                   "--report", small.path("r.json")},
                  more));
    return Json::parse(read_text(small.path("r.json")));
}

TEST(Refine, ReceiversAreAddedByDefaultAndTheFileSaysWhich) {
    const SmallScene small;
    const Json report = bake_report(small, {});
    const Json refined = report.at("refinement");
    EXPECT_EQ(refined.at("receivers_given"), 8);
    EXPECT_GT(refined.at("receivers_added"), 20);
    EXPECT_LT(refined.at("error_after"), 0.1);
    EXPECT_GT(refined.at("error_before"), 0.1);
    const Json info = print_json("info", {small.path("a.opal"), "--json"});
    EXPECT_EQ(info.at("receivers"), 8 + refined.at("receivers_added").get<int>());
    int added = 0;
    for (const Json& primitive : info.at("primitives")) {
        added += primitive.at("vertices_added").get<int>();
    }
    EXPECT_EQ(added, refined.at("receivers_added"));
    EXPECT_EQ(run_well({"verify", small.path("a.opal")}).exit_code, 0);
}

TEST(Refine, ItsErrorBetweenReceiversFalls) {
    const SmallScene small;
    const auto between = [&](const char* refine) {
        const Json report = bake_report(small, {"--refine", refine});
        return report.at("error").at("between").at("rms_relative").get<double>();
    };
    EXPECT_LT(between("auto"), 0.5 * between("off"));
}

TEST(Refine, OffAddsNone) {
    const SmallScene small;
    EXPECT_EQ(bake_report(small, {"--refine", "off"}).at("output").at("receivers"), 8);
}

TEST(Refine, ALengthBoundsEdges) {
    const SmallScene small;
    const Json report = bake_report(small, {"--refine", "0.5"});
    EXPECT_GT(report.at("refinement").at("receivers_added"), 8);
    EXPECT_EQ(report.at("refinement").at("error_before"), 0);
}

TEST(Refine, ALimitThatBindsIsAWarning) {
    const SmallScene small;
    const Outcome bake = run_well({"bake", small.scene(), "-o", small.path("a.opal"), "--quality",
                                   "draft", "--max-receivers", "12"});
    EXPECT_THAT(bake.err, HasSubstr("refinement: the limit of 12 receivers is reached"));
}

TEST(Refine, PlanSaysHowManyWithoutABake) {
    const SmallScene small;
    const Json plan = print_json("plan", {small.scene(), "--json", "--quality", "draft"});
    const Json report = bake_report(small, {});
    EXPECT_EQ(plan.at("refinement"), report.at("refinement"));
}

TEST(Refine, WhatIsNeitherIsRefused) {
    const SmallScene small;
    for (const char* value : {"on", "0", "-1", "nan", "1e99", ""}) {
        expect_refused({"bake", small.scene(), "-o", small.path("a.opal"), "--refine", value}, 2,
                       "--refine");
    }
    for (const char* value : {"0", "-5", "many", "99999999999999999999"}) {
        expect_refused(
            {"bake", small.scene(), "-o", small.path("a.opal"), "--max-receivers", value}, 2,
            "--max-receivers");
    }
    expect_refused({"bake", small.scene(), "-o", small.path("a.opal"), "--refine", "off",
                    "--max-receivers", "100"},
                   2, "--max-receivers");
    EXPECT_EQ(list_folder(small.folder()), std::vector<std::string>{"scene.glb"});
}

}  // namespace
}  // namespace opaline::tests
