#pragma once

#include "tests/support/reference_table.h"

namespace opaline::tests {

/// Checks all rows of translucency.csv that are called `check` against value(row).
template <class Value>
void expect_rows(const char* check, Value&& value) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", check);
    for (const ReferenceRow& row : rows) {
        EXPECT_NEAR(value(row), row.expected, row.tolerance()) << row.name();
    }
}

}  // namespace opaline::tests
