#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace opaline::tests {

/// Pearson's statistic of counts in cells. Cells where fewer than 20 are expected are one.
struct ChiSquare {
    double sum = 0;
    int cells = 0;

    /// `rest_expected`, `rest_found`: outside of all cells.
    ChiSquare(std::span<const double> expected, std::span<const double> found, double rest_expected,
              double rest_found) {
        constexpr double kFew = 20;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            if (expected[i] < kFew) {
                rest_expected += expected[i];
                rest_found += found[i];
            } else {
                add(expected[i], found[i]);
            }
        }
        if (rest_expected > kFew) {
            add(rest_expected, rest_found);
        }
    }

    /// In standard deviations: the cube root of the sum over its degrees of freedom is nearly
    /// normal (Wilson and Hilferty).
    double deviate() const {
        const double k = cells - 1, w = 2 / (9 * k);
        return (std::cbrt(sum / k) - (1 - w)) / std::sqrt(w);
    }

  private:
    void add(double expected, double found) {
        sum += (found - expected) * (found - expected) / expected;
        ++cells;
    }
};

}  // namespace opaline::tests
