#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "bake/lab/sweep/report_page.h"
#include "bake/lab/sweep/tables.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

runtime::Picture grey(float value) {
    return {2, 1, {{value, value, value}, {0.5f, 0.5f, 0.5f}}};
}

// Three bakes by hand: the truth, a good one, a bad one.
SweepResult small_sweep(const std::string& name) {
    SweepResult result;
    result.source = name;
    result.lights = {"white", "sun:30,60"};
    PlanEntry entry;
    entry.name = "direct";
    entry.subject.name = "material '" + name + "'";
    entry.on = true;
    result.plan = {entry};
    const double seconds[] = {8, 2, 4}, errors[] = {1e-3, 0.02, 0.2};
    for (std::size_t i = 0; i < 3; ++i) {
        PointRecord record;
        record.point.label = i == 0 ? "reference" : "N = 8, M = " + std::to_string(i);
        record.point.rungs = {{i == 0 ? Ladders::preset : Ladders::grid, 3}};
        record.seconds = seconds[i];
        record.groups = {{"preparation", 1.0}, {"direct: rows", 1.0}};
        record.bytes = 3000 - 1000 * i;
        record.error.rms_relative = errors[i];
        record.error.ci95[0] = record.error.ci95[1] = errors[i];
        record.error.by_effect = {{"direct", errors[i]}};
        record.error.by_light = {{"white", errors[i]}, {"sun:30,60", errors[i]}};
        record.against_finest = record.error;
        record.total.rms_relative = 0.03;
        record.total.receivers_checked = 64;
        record.luminance = {1.0 + errors[i]};
        record.picture = grey(0.5f + static_cast<float>(errors[i]));
        result.points.push_back(record);
    }
    return result;
}

std::vector<std::string> csv_lines(const SweepResult& result) {
    std::istringstream lines(make_sweep_csv(result, analyse_sweep(result)));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) {
        rows.push_back(line);
    }
    return rows;
}

Json json_of(const SweepResult& result) {
    return make_sweep_json(result, analyse_sweep(result));
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++found;
    }
    return found;
}

TEST(SweepCsv, HasOneRowAPointAndAsManyCellsAsColumns) {
    const std::vector<std::string> rows = csv_lines(small_sweep("plain"));
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_THAT(rows[0], HasSubstr("label,ladders,truth,cubemap,coefficients"));
    EXPECT_THAT(rows[2], ::testing::StartsWith("\"N = 8, M = 1\",grid,0,16,128,8,"));
    // Quoted: the label's comma, and that of "error sun:30,60" in the head.
    const auto columns = static_cast<std::size_t>(std::count(rows[0].begin(), rows[0].end(), ','));
    EXPECT_EQ(std::count(rows[1].begin(), rows[1].end(), ','), columns - 1);
    EXPECT_EQ(std::count(rows[2].begin(), rows[2].end(), ','), columns);
}

TEST(SweepCsv, ReferenceStandsBelowTheBakesInTheSameColumns) {
    SweepResult result = small_sweep("plain");
    result.reference = {"studio", 256, 32, {{4, 0.5, 0.2, 0.21}, {16, 2, 0.1, 0.1}}};
    const std::vector<std::string> rows = csv_lines(result);
    ASSERT_EQ(rows.size(), 6u);
    EXPECT_THAT(rows[5], ::testing::StartsWith("\"Monte Carlo, 16 samples\",reference_samples,0,"));
    EXPECT_THAT(rows[5], ::testing::EndsWith(",16"));
    EXPECT_THAT(rows[5], HasSubstr(",2,"));
    EXPECT_THAT(rows[5], HasSubstr(",0.1,"));
    EXPECT_EQ(std::count(rows[5].begin(), rows[5].end(), ','),
              std::count(rows[2].begin(), rows[2].end(), ','));
    const Json json = json_of(result);
    const Json& slope = json.at("slopes").back();
    EXPECT_EQ(slope.at("ladder"), "reference_samples");
    EXPECT_EQ(slope.at("theory").at("rate"), -0.5);
    EXPECT_NEAR(slope.at("measured").at("rate").get<double>(), -0.5, 1e-9);
    EXPECT_EQ(slope.at("rungs").at(1).at("seconds"), 2);
    EXPECT_EQ(json.at("reference").at("rungs").at(0).at("stated"), 0.21);
}

TEST(SweepJson, SaysWhatIsOnTheFrontAndHowFarTheRestIsOff) {
    const Json json = json_of(small_sweep("plain"));
    EXPECT_EQ(json.at("points").at(0).at("on_front_time"), true);
    EXPECT_EQ(json.at("points").at(1).at("on_front_time"), true);
    EXPECT_EQ(json.at("points").at(2).at("on_front_time"), false);
    EXPECT_EQ(json.at("points").at(2).at("times_front_time"), 2);
    EXPECT_EQ(json.at("agreement").at("agreeing"), 2);
    EXPECT_NEAR(json.at("answer").at("error").get<double>(), 0.01, 1e-12);
}

TEST(SweepJson, TotalErrorStandsBesideThatOfTheNumbersAndTheFinestBakesIsTheModels) {
    SweepResult result = small_sweep("plain");
    result.points[1].choices = "walks";
    result.points[1].total.rms_relative = 0.01;
    result.points[1].total.bias = -0.005;
    result.points[2].total = {};
    const Json json = json_of(result);
    EXPECT_EQ(json.at("model_error").at("rms_relative"), 0.03);
    EXPECT_EQ(json.at("model_error").at("receivers_checked"), 64);
    EXPECT_EQ(json.at("points").at(1).at("total_error").at("rms_relative"), 0.01);
    EXPECT_EQ(json.at("points").at(1).at("total_error").at("bias"), -0.005);
    EXPECT_EQ(json.at("lines").at(1).at("choices"), "walks");
    EXPECT_EQ(json.at("lines").at(1).at("points"), Json({1}));
    EXPECT_FALSE(json.at("points").at(2).contains("total_error")) << "0 would read as no error";
}

// A name that would end the script element, open a comment, or is no UTF-8.
TEST(ReportPage, HostileNamesStayText) {
    const std::string name = "</script><script>alert(1)</script><!--&lt;\xff\xfe\"'/*DATA*/";
    const SweepResult result = small_sweep(name);
    const SweepAnalysis analysis = analyse_sweep(result);
    const Json json = make_sweep_json(result, analysis);
    const auto page = make_report_page(result, analysis, json);
    ASSERT_TRUE(page);
    EXPECT_THAT(*page, Not(HasSubstr("alert(1)</script>")));
    EXPECT_EQ(count(*page, "</script>"), 6u);
    const Json same = Json::parse(json_for_html(json));
    EXPECT_THAT(same.at("scene").at("name").get<std::string>(),
                ::testing::StartsWith("</script><script>alert(1)</script><!--&lt;"));
}

TEST(ReportPage, NeedsNothingFromAnywhereElse) {
    const SweepResult result = small_sweep("plain");
    const SweepAnalysis analysis = analyse_sweep(result);
    const auto page = make_report_page(result, analysis, make_sweep_json(result, analysis));
    ASSERT_TRUE(page);
    EXPECT_THAT(*page, Not(::testing::ContainsRegex("src=\"?http")));
    EXPECT_THAT(*page, Not(::testing::ContainsRegex("href=\"?http")));
    EXPECT_THAT(*page, Not(HasSubstr("@import")));
    EXPECT_THAT(*page, HasSubstr("Released under the MIT License"));  // Chart.js asks for it
    for (const char* mark : {"/*STYLE*/", "/*LIBRARY*/", "/*POINTS*/", "/*CHARTS*/", "/*PAGE*/",
                             "/*DATA*/", "/*PICTURES*/"}) {
        EXPECT_THAT(*page, Not(HasSubstr(mark)));
    }
}

TEST(Difference, IsBlueWhereDarkerVermilionWhereBrighterWhiteWhereEqual) {
    const runtime::Picture truth = grey(0.5f);
    const formats::Image8 darker = draw_difference(grey(0.4f), truth, 0.1);
    const formats::Image8 brighter = draw_difference(grey(0.9f), truth, 0.1);
    EXPECT_THAT(std::vector(darker.rgba.begin(), darker.rgba.begin() + 3),
                ::testing::ElementsAre(0, 114, 178));
    EXPECT_THAT(std::vector(brighter.rgba.begin(), brighter.rgba.begin() + 3),
                ::testing::ElementsAre(213, 94, 0));  // beyond the scale: full colour
    EXPECT_THAT(std::vector(brighter.rgba.begin() + 4, brighter.rgba.end()),
                ::testing::ElementsAre(255, 255, 255, 255));
}

TEST(Difference, ScaleIsARoundNumberThatHoldsWhatDiffers) {
    const runtime::Picture truth = grey(0.5f), a = grey(0.53125f), b = grey(0.484375f);
    const runtime::Picture* both[] = {&a, &b};
    EXPECT_NEAR(difference_scale(both, truth), 0.02, 1e-12);  // the second largest of two
    const runtime::Picture* first[] = {&a};
    EXPECT_NEAR(difference_scale(first, truth), 0.05, 1e-12);
    const runtime::Picture* same[] = {&truth};
    EXPECT_EQ(difference_scale(same, truth), 1);
}

}  // namespace
}  // namespace opaline::bake
