#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "tests/support/named_table.h"
#include "tests/support/reference_table.h"

namespace opaline::tests {

using NamedValues = std::map<std::string, std::vector<double>>;

/// All rows of one case of path-differentials.csv (tests/data/reference/README.md).
struct DifferentialCase {
    std::string event, name;
    NamedValues in, out;
    std::map<std::string, double> tolerance;  ///< of each output, relative to its largest component

    double number(const std::string& key) const { return in.at(key).at(0); }
    double number_or(const std::string& key, double otherwise) const {
        return in.contains(key) ? number(key) : otherwise;
    }
    glm::dvec3 vector(const std::string& key) const {
        const std::vector<double>& v = in.at(key);
        return {v.at(0), v.at(1), v.at(2)};
    }
    glm::dvec2 pair(const std::string& key) const { return {in.at(key).at(0), in.at(key).at(1)}; }
};

inline std::vector<DifferentialCase> read_differential_cases() {
    std::vector<DifferentialCase> cases;
    for (const auto& row : read_named_table(reference_folder() / "path-differentials.csv")) {
        if (cases.empty() || cases.back().event != row.at("event") ||
            cases.back().name != row.at("case")) {
            cases.push_back({row.at("event"), row.at("case"), {}, {}, {}});
        }
        const std::string& name = row.at("name");
        const bool is_input = row.at("role") == "in";
        std::vector<double>& values = (is_input ? cases.back().in : cases.back().out)[name];
        EXPECT_EQ(std::stoul(row.at("i")), values.size()) << name;
        values.push_back(std::stod(row.at("value")));
        if (!is_input) {
            cases.back().tolerance[name] = std::stod(row.at("rtol"));
        }
    }
    return cases;
}

inline std::vector<double> listed(double v) {
    return {v};
}
inline std::vector<double> listed(const glm::dvec2& v) {
    return {v.x, v.y};
}
inline std::vector<double> listed(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Every output of the table has a computed value within its tolerance.
inline void expect_outputs(const DifferentialCase& row, const NamedValues& computed) {
    for (const auto& [name, expected] : row.out) {
        const std::string label = row.event + " " + row.name + " " + name;
        const auto found = computed.find(name);
        ASSERT_TRUE(found != computed.end()) << label << " is not computed";
        ASSERT_EQ(found->second.size(), expected.size()) << label;
        double largest = 0;
        for (const double v : expected) {
            largest = std::max(largest, std::abs(v));
        }
        const double tolerance = largest > 0 ? row.tolerance.at(name) * largest : 1e-300;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_NEAR(found->second[i], expected[i], tolerance) << label << " " << i;
        }
    }
}

}  // namespace opaline::tests
