#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace opaline::tests {

/// The lines of a table of values, each as its cells by the names in the table's first line. Cells
/// that a line lacks are empty. Empty if the file is not there.
inline std::vector<std::map<std::string, std::string>> read_named_table(
    const std::filesystem::path& path) {
    std::ifstream file(path);
    const auto split = [](const std::string& line) {
        std::stringstream cells(line);
        std::vector<std::string> parts;
        for (std::string part; std::getline(cells, part, ',');) {
            parts.push_back(part);
        }
        return parts;
    };
    std::vector<std::string> columns;
    std::vector<std::map<std::string, std::string>> rows;
    for (std::string line; std::getline(file, line);) {
        const std::vector<std::string> parts = split(line);
        if (columns.empty()) {
            columns = parts;
            continue;
        }
        std::map<std::string, std::string>& row = rows.emplace_back();
        for (std::size_t i = 0; i < columns.size(); ++i) {
            row[columns[i]] = i < parts.size() ? parts[i] : "";
        }
    }
    return rows;
}

}  // namespace opaline::tests
