#include "tests/stability/stability_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "tests/stability/error_curves.h"

namespace opaline::tests {
namespace {

std::string read_text(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(StabilityTable, OursIsWithinItsBoundOfTheExactValueWhereTheNaiveFormIsNot) {
    const auto exact = read_exact_values();
    std::set<std::string> used;
    for (const StabilityField& field : stability_fields()) {
        for (const StabilityRow& row : field.rows) {
            SCOPED_TRACE(field.name + ": " + row.hard_case + ": " + row.inputs);
            const auto found = exact.find(row.exact);
            ASSERT_NE(found, exact.end())
                << "add the line '" << row.exact << "' to exact.tsv and run exact.py";
            EXPECT_LE(error_of(row.ours, found->second), row.bound) << row.ours;
            EXPECT_GE(error_of(row.naive, found->second), row.naive_errs)
                << row.naive << ": the naive form does not fail, and the row goes";
            EXPECT_GT(row.naive_errs, row.bound) << "the naive form would do";
            used.insert(row.exact);
        }
    }
    for (const ErrorCurve& curve : error_curves()) {
        for (const ErrorCurve::Point& point : curve.points) {
            used.insert(point.exact);
        }
    }
    for (const auto& [expression, value] : exact) {
        EXPECT_TRUE(used.contains(expression)) << "no row has " << expression;
    }
}

// Without what rounding alone decides, which another machine's library may do otherwise: results of
// naive forms, and how high the lines of the picture run.
std::string without_noise(const std::string& text) {
    static const std::regex naive("^((\\| [^\n]*?[^\\\\] ){3}\\| )-?[0-9][0-9.e+-]*( \\| [^ |])",
                                  std::regex::multiline);
    static const std::regex points("points='[^']*'");
    return std::regex_replace(std::regex_replace(text, naive, "$1#$3"), points, "");
}

TEST(StabilityTable, TheFilesAreCurrent) {
    const std::string folder = OPALINE_SOURCE_DIR "/tests/stability/";
    for (const auto& [name, text] :
         {std::pair{"TABLE.md", print_table(stability_fields(), read_exact_values())},
          {"errors.svg", print_error_curves(error_curves(), read_exact_values())}}) {
        if (without_noise(read_text(folder + name)) == without_noise(text)) continue;
        std::ofstream(name) << text;
        ADD_FAILURE() << folder << name << " is not current: copy " << name
                      << " from the folder that this test ran in";
    }
}

}  // namespace
}  // namespace opaline::tests
