#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/stability/stability_row.h"

namespace opaline::tests {

std::vector<StabilityField> stability_fields();

/// Of exact.tsv: expressions and their values, which exact.py computes with mpmath.
std::map<std::string, long double> read_exact_values();

/// Relative; absolute where `exact` is 0. Infinite where `value` is no finite number.
double error_of(double value, long double exact);

/// TABLE.md. Errors stand as the bounds that the test asserts.
std::string print_table(const std::vector<StabilityField>& fields,
                        const std::map<std::string, long double>& exact);

}  // namespace opaline::tests
