#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

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
    std::ifstream file(reference_folder() / "volumes.csv");
    const auto split = [](const std::string& line) {
        std::stringstream cells(line);
        std::vector<std::string> parts;
        for (std::string part; std::getline(cells, part, ',');) {
            parts.push_back(part);
        }
        return parts;
    };
    std::vector<std::string> columns;
    std::vector<VolumeRow> rows;
    for (std::string line; std::getline(file, line);) {
        const std::vector<std::string> parts = split(line);
        if (columns.empty()) {
            columns = parts;
            continue;
        }
        VolumeRow row;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            row.cell[columns[i]] = i < parts.size() ? parts[i] : "";
        }
        rows.push_back(row);
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
