#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/named_table.h"
#include "tests/support/reference_table.h"

namespace opaline::tests {

/// One row of volumes.csv: a value for named inputs.
struct VolumeRow {
    std::map<std::string, std::string> cell;  ///< by column

    double number(const std::string& column) const { return std::stod(cell.at(column)); }
    /// 0 where the cell is empty.
    double number_or_zero(const std::string& column) const {
        return cell.at(column).empty() ? 0 : number(column);
    }
    double value() const { return number("value"); }
    const std::string& id() const { return cell.at("id"); }
};

/// All rows of the table. Empty if it is not there.
inline std::vector<VolumeRow> read_volume_table() {
    std::vector<VolumeRow> rows;
    for (auto& cell : read_named_table(reference_folder() / "volumes.csv")) {
        rows.push_back({std::move(cell)});
    }
    return rows;
}

/// Those whose quantity is `quantity`.
inline std::vector<VolumeRow> read_volume_rows(const std::string& quantity) {
    std::vector<VolumeRow> rows = read_volume_table();
    std::erase_if(rows, [&](const VolumeRow& r) { return r.cell.at("quantity") != quantity; });
    return rows;
}

}  // namespace opaline::tests

/// Reads the rows of a quantity into `rows`, or skips the test, by name, where the table is absent.
#define OPALINE_VOLUME_ROWS(rows, quantity)                       \
    OPALINE_NEEDS_REFERENCE("volumes.csv");                       \
    const auto rows = opaline::tests::read_volume_rows(quantity); \
    ASSERT_FALSE(rows.empty()) << "the table has no rows of " << (quantity)
