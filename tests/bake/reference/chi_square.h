#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/reference/ggx.h"
#include "bake/reference/random_stream.h"

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

/// Whether `samples` of `sample(random)`, an optional direction, are distributed as `pdf` [1/sr]
/// says: in cells even in height above `lowest` and in azimuth of the frame, and one cell for what
/// is lost.
template <class Pdf, class Sample>
void expect_distribution(const bake::Frame& frame, double lowest, std::uint32_t samples, Pdf&& pdf,
                         Sample&& sample, const std::string& what) {
    constexpr int kRows = 16, kColumns = 16, kFine = 32;
    std::vector<double> expected(kRows * kColumns), found(kRows * kColumns);
    const double solid_angle = 2 * std::numbers::pi * (1 - lowest);
    double all = 0;
    for (int r = 0; r < kRows * kFine; ++r) {
        for (int c = 0; c < kColumns * kFine; ++c) {
            const double z = lowest + (1 - lowest) * (r + 0.5) / (kRows * kFine);
            const double s = std::sqrt(1 - z * z);
            const double phi = 2 * std::numbers::pi * (c + 0.5) / (kColumns * kFine);
            const glm::vec3 d = frame.to_world(glm::vec3(s * std::cos(phi), s * std::sin(phi), z));
            const double share = pdf(d) * solid_angle / (kRows * kFine * kColumns * kFine);
            expected[(r / kFine) * kColumns + c / kFine] += share * samples;
            all += share;
        }
    }
    EXPECT_LT(all, 1 + 2e-3) << what;
    double lost = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        bake::RandomStream random(23, 4, i);
        const std::optional<glm::vec3> direction = sample(random);
        if (!direction) {
            ++lost;
            continue;
        }
        const glm::dvec3 d = bake::into_frame(frame, *direction);
        const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
        const int row = static_cast<int>((d.z - lowest) / (1 - lowest) * kRows);
        const int column = static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns);
        found[std::clamp(row, 0, kRows - 1) * kColumns + std::clamp(column, 0, kColumns - 1)] += 1;
    }
    const ChiSquare chi(expected, found, (1 - all) * samples, lost);
    ASSERT_GT(chi.cells, 3) << what;
    EXPECT_LT(chi.deviate(), 4) << what << ", chi2 " << chi.sum << " in " << chi.cells << " cells";
}

}  // namespace opaline::tests
