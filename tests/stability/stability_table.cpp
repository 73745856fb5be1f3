#include "tests/stability/stability_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>

namespace opaline::tests {
namespace {

std::string number(const char* format, double value) {
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// Digits that are wrong need not be many.
std::string printed_naive(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
    return number("%.2g", value);
}

// Vertical bars end cells.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
        text.insert(at, "\\");
    }
    return text;
}

}  // namespace

std::vector<StabilityField> stability_fields() {
    return {surface_rows(), walk_rows(),    volume_rows(), differential_rows(),
            layer_rows(),   droplet_rows(), mie_rows(),    exchange_rows()};
}

std::map<std::string, long double> read_exact_values() {
    std::ifstream file(OPALINE_SOURCE_DIR "/tests/stability/exact.tsv");
    std::map<std::string, long double> values;
    for (std::string line; std::getline(file, line);) {
        const std::size_t tab = line.find('\t');
        if (tab != std::string::npos) {
            values[line.substr(0, tab)] = std::strtold(line.c_str() + tab + 1, nullptr);
        }
    }
    return values;
}

double error_of(double value, long double exact) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
    const long double error = std::abs(static_cast<long double>(value) - exact);
    return static_cast<double>(exact == 0 ? error : error / std::abs(exact));
}

std::string print_table(const std::vector<StabilityField>& fields,
                        const std::map<std::string, long double>& exact) {
    std::string text =
        "# Hard cases in numbers\n\n"
        "Written by `stability_table_test`, which asserts every bound of it. The naive form is "
        "that of textbooks, in\n"
        "double precision where nothing else is said; ours is the function that the program calls. "
        "The exact value is\n"
        "that of the expression, evaluated with 250 digits by [`exact.py`](exact.py) apart from "
        "the program. Errors are\n"
        "relative, absolute where the value is 0.\n";
    for (const StabilityField& field : fields) {
        text += "\n## " + field.name +
                "\n\n| hard case | what is computed | naive form | gives | errs at least | ours | "
                "errs at "
                "most | exact value |\n|---|---|---|---|---:|---:|---:|---|\n";
        for (const StabilityRow& row : field.rows) {
            const double value = static_cast<double>(exact.at(row.exact));
            const bool finite = std::isfinite(row.naive);
            // Of ours as many digits as the bound grants, and six at most.
            const int digits =
                std::clamp(row.bound > 0 ? static_cast<int>(-std::log10(row.bound)) : 6, 1, 6);
            const double shown = value == 0 && std::abs(row.ours) <= row.bound ? 0 : row.ours;
            text += "| " + cell(row.hard_case) + " | " + cell(row.inputs) + " | " +
                    cell(row.naive_form) + " | " + printed_naive(row.naive) + " | " +
                    (finite ? number("%g", row.naive_errs) : "") + " | " +
                    number(("%." + std::to_string(digits) + "g").c_str(), shown) + " | " +
                    number("%g", row.bound) + " | `" + cell(row.exact) + "` |\n";
        }
    }
    return text;
}

}  // namespace opaline::tests
