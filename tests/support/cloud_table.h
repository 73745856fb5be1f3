#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/named_table.h"
#include "tests/support/reference_table.h"

namespace opaline::tests {

/// One row of clouds.csv: a value for named inputs (tests/data/reference/README.md).
struct CloudRow {
    std::map<std::string, std::string> cell;  ///< by column

    const std::string& text(const std::string& column) const { return cell.at(column); }
    double number(const std::string& column) const { return std::stod(text(column)); }
    /// That, or `otherwise` where the cell is empty.
    double number_or(const std::string& column, double otherwise) const {
        return text(column).empty() ? otherwise : number(column);
    }
    double value() const { return number("value"); }
    /// The tolerance of the row, or one standard deviation of a Monte Carlo row.
    double error() const { return number("err"); }
    std::string name() const {
        std::string all;
        for (const auto& [column, value] : cell) {
            if (!value.empty()) {
                all += column + "=" + value + " ";
            }
        }
        return all;
    }
};

/// The rows of a kind. Empty if the table is not there.
inline std::vector<CloudRow> read_cloud_rows(const std::string& kind) {
    std::vector<CloudRow> rows;
    for (auto& cell : read_named_table(reference_folder() / "clouds.csv")) {
        if (cell.at("kind") == kind) {
            rows.push_back({std::move(cell)});
        }
    }
    return rows;
}

}  // namespace opaline::tests

/// Reads the rows of a kind into `rows`, or skips the test, by name, where the table is absent.
#define OPALINE_CLOUD_ROWS(rows, kind)                       \
    OPALINE_NEEDS_REFERENCE("clouds.csv");                   \
    const auto rows = opaline::tests::read_cloud_rows(kind); \
    ASSERT_FALSE(rows.empty()) << "the table has no rows of " << (kind)
