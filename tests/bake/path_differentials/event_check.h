#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bake/path_differentials/primal.h"
#include "tests/bake/path_differentials/random_inputs.h"

namespace opaline::tests {

/// Columns are derivatives: to rounding by dual numbers, and to 1e-7 by central differences.
inline void expect_derivatives(const ColumnErrors& errors, double dual_tolerance = 1e-12,
                               double difference_tolerance = 1e-7) {
    EXPECT_TRUE(errors.finite);
    EXPECT_LT(errors.dual, dual_tolerance);
    EXPECT_LT(errors.difference, difference_tolerance);
}

/// Largest relative error of area times pdf, which is 1 where (u, v) samples the pdf.
struct AreaErrors {
    double largest = 0;

    void add(const glm::dvec3& du, const glm::dvec3& dv, double pdf) {
        const double product = glm::length(glm::cross(du, dv)) * pdf;
        largest = std::max(largest, std::abs(product - 1));
    }
};

/// Near the diagonals of the concentric map the columns jump.
inline bool is_near_diagonal(double u, double v) {
    return std::abs(std::abs(2 * u - 1) - std::abs(2 * v - 1)) < 0.01;
}

}  // namespace opaline::tests
