#include "tests/stability/stability_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
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

// Of a cell of README: "NaN" and "∞" are what they say.
double number_of(const std::string& cell) {
    return cell == "∞" ? HUGE_VAL : std::strtod(cell.c_str(), nullptr);
}

bool is_near(double a, double b, double tolerance) {
    return (std::isnan(a) && std::isnan(b)) || a == b || std::abs(a - b) <= tolerance * std::abs(b);
}

// case | textbook's form | ours | exact | ours errs at most
TEST(StabilityTable, TheRowsThatReadmeShowsAreInIt) {
    const auto exact = read_exact_values();
    const auto fields = stability_fields();
    const std::string text = read_text(OPALINE_SOURCE_DIR "/README.md");
    std::istringstream lines(text.substr(text.find("| hard case |")));
    std::string line;
    std::getline(lines, line);
    std::getline(lines, line);
    int shown = 0;
    for (; std::getline(lines, line) && line.starts_with("| "); ++shown) {
        static const std::regex cells(
            "\\| (.*) \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\| ([^|]*) \\|");
        std::smatch cell;
        ASSERT_TRUE(std::regex_match(line, cell, cells)) << line;
        const double naive = number_of(cell[2]), ours = number_of(cell[3]),
                     value = number_of(cell[4]), bound = number_of(cell[5]);
        bool is_found = false;
        for (const StabilityField& field : fields) {
            for (const StabilityRow& row : field.rows) {
                is_found =
                    is_found || (row.bound == bound && is_near(row.naive, naive, 0.1) &&
                                 is_near(row.ours, ours, 1e-5) &&
                                 is_near(static_cast<double>(exact.at(row.exact)), value, 1e-5));
            }
        }
        EXPECT_TRUE(is_found) << line;
    }
    EXPECT_EQ(shown, 10);
}

}  // namespace
}  // namespace opaline::tests
