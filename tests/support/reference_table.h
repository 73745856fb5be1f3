#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace opaline::tests {

/// Where the value tables lie: the folder that OPALINE_REFERENCE_DIR names, or the project's own.
inline std::filesystem::path reference_folder() {
    const char* given = std::getenv("OPALINE_REFERENCE_DIR");
    return given != nullptr ? std::filesystem::path(given)
                            : std::filesystem::path(OPALINE_SOURCE_DIR) / "tests/data/reference";
}

/// One row of a reference table: check, inputs, expected, tolerances.
struct ReferenceRow {
    std::string check, inputs;
    std::map<std::string, std::string> input;
    double expected = 0, rel_tol = 0, abs_tol = 0;

    double number(const std::string& key) const { return std::stod(input.at(key)); }
    /// max(abs_tol, rel_tol |expected|)
    double tolerance() const { return std::max(abs_tol, rel_tol * std::abs(expected)); }
    /// That, or what a stage's own discretisation may differ by, relative to the expected value.
    double tolerance_or(double relative) const {
        return std::max(tolerance(), relative * std::abs(expected));
    }
    std::string name() const { return check + " [" + inputs + "]"; }
};

/// All rows of `table` whose check is `check`. Empty if the table is not there.
inline std::vector<ReferenceRow> read_reference(const std::string& table,
                                                const std::string& check) {
    std::ifstream file(reference_folder() / table);
    std::vector<ReferenceRow> rows;
    std::string line;
    while (std::getline(file, line)) {
        std::stringstream cells(line);
        std::vector<std::string> cell;
        for (std::string part; std::getline(cells, part, ',');) {
            cell.push_back(part);
        }
        if (cell.size() < 5 || cell[0] != check) continue;
        ReferenceRow row{cell[0],           cell[1], {}, std::stod(cell[2]), std::stod(cell[3]),
                         std::stod(cell[4])};
        std::stringstream pairs(cell[1]);
        for (std::string pair; std::getline(pairs, pair, ';');) {
            const std::size_t equals = pair.find('=');
            row.input[pair.substr(0, equals)] = pair.substr(equals + 1);
        }
        rows.push_back(row);
    }
    return rows;
}

}  // namespace opaline::tests

/// Skips the test, by name, where OPALINE_REFERENCE_DIR names a folder without the table. The
/// project's own folder always has it: there its absence is a failure.
#define OPALINE_NEEDS_REFERENCE(table)                                                       \
    if (const auto file = opaline::tests::reference_folder() / (table);                      \
        std::getenv("OPALINE_REFERENCE_DIR") != nullptr && !std::filesystem::exists(file)) { \
        GTEST_SKIP() << "no table " << file.string()                                         \
                     << " (unset OPALINE_REFERENCE_DIR to read the project's own)";          \
    }

/// Reads the rows of a check into `rows`, or skips the test, by name, where the table is absent.
#define OPALINE_REFERENCE_ROWS(rows, table, check)                  \
    OPALINE_NEEDS_REFERENCE(table);                                 \
    const auto rows = opaline::tests::read_reference(table, check); \
    ASSERT_FALSE(rows.empty()) << "the table has no rows of " << (check)
