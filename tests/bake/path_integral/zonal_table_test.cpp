#include "bake/physics/path_integral/zonal_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/physics/path_integral/turn.h"
#include "bake/physics/phase.h"
#include "tests/bake/scattering/phase_support.h"

namespace opaline::bake {
namespace {

constexpr double kEven = 1 / (4 * std::numbers::pi);
constexpr PathKernel kKernels[] = {PathKernel::ray, PathKernel::source};

double by_series(PathKernel kernel, const PhaseSeries& series, double cosine, double ell) {
    return kernel_factor(kernel, ell) * eval_zonal(path_moments(kernel, series, ell), cosine);
}

// Between nodes, and dense at both ends.
std::vector<double> cosines() {
    std::vector<double> list{-1, 1};
    for (double x = 1e-6; x < 1; x *= 1.7) {
        list.push_back(1 - x);
        list.push_back(x - 1);
    }
    return list;
}

struct Errors {
    double relative = 0;  ///< to the value itself, or 1 / (4 pi) where it is smaller
    double of_peak = 0;   ///< to the largest value at the same depth
};

Errors table_errors(PathKernel kernel, const PhaseSeries& series) {
    const ZonalTable table = make_zonal_table(kernel, series);
    std::vector<ZonalRow> rows;
    for (const double cosine : cosines()) {
        rows.push_back(interpolate_row(table, cosine));
    }
    Errors errors;
    for (double ell = 1e-4; ell < 1e4; ell *= 1.9) {
        double worst = 0, peak = 0;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double exact = by_series(kernel, series, cosines()[i], ell);
            const double scale = std::max(std::abs(exact), kEven * kernel_factor(kernel, ell));
            const double error = std::abs(rows[i](ell) - exact);
            errors.relative = std::max(errors.relative, error / scale);
            worst = std::max(worst, error);
            peak = std::max(peak, std::abs(exact));
        }
        errors.of_peak = std::max(errors.of_peak, worst / peak);
    }
    return errors;
}

TEST(ZonalTable, IsWithin1e4OfTheSeries) {
    for (const PathKernel kernel : kKernels) {
        for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.75, 0.9, 0.99}) {
            const Errors errors = table_errors(kernel, expand_henyey_greenstein(g, 1500));
            EXPECT_LT(errors.relative, 1e-4) << g;
        }
        const formats::PhaseFunction phases[] = {tests::rayleigh(), tests::gaussian(0.11f),
                                                 tests::gaussian(0.5f)};
        for (const formats::PhaseFunction& phase : phases) {
            const Errors errors = table_errors(kernel, expand_phase(phase, 400));
            EXPECT_LT(errors.of_peak, 1e-4);
        }
        for (const double g : {0.9, 0.99}) {
            const Errors errors =
                table_errors(kernel, split_forward_peak(expand_henyey_greenstein(g, 6), 4).rest);
            EXPECT_LT(errors.of_peak, 1e-4) << g;
        }
    }
}

TEST(ZonalTable, ThinPathsScatterTwice) {
    for (const double g : {-0.7, 0.6, 0.9}) {
        const PhaseSeries series = expand_henyey_greenstein(g, 400);
        const ZonalTable ray = make_zonal_table(PathKernel::ray, series);
        const ZonalTable source = make_zonal_table(PathKernel::source, series);
        for (const double cosine : {-1.0, 0.1, 0.99, 1.0}) {
            const double twice = henyey_greenstein(cosine, g * g);
            EXPECT_NEAR(interpolate_row(source, cosine)(0) / twice, 1, 1e-4);
            EXPECT_EQ(interpolate_row(ray, cosine)(0), 0);
            EXPECT_NEAR(interpolate_row(ray, cosine)(1e-12) / (1e-12 * twice), 1, 1e-4);
        }
    }
}

TEST(ZonalTable, DeepPathsScatterEvenlyAndEveryDepthIsFinite) {
    for (const PathKernel kernel : kKernels) {
        for (const double g : {-0.99, -0.3, 0.0, 0.75, 0.99}) {
            const ZonalTable table = make_zonal_table(kernel, expand_henyey_greenstein(g, 1500));
            for (const double cosine : {-1.0, 0.0, 1.0, 1 + 1e-15}) {
                const ZonalRow row = interpolate_row(table, cosine);
                for (const double ell :
                     {5e3, 1e9, 1e300, std::numeric_limits<double>::infinity()}) {
                    EXPECT_NEAR(row(ell), kEven, 1e-5 * kEven) << g << ' ' << ell;
                }
                for (double ell = 0; ell < 1e6; ell = 1.3 * ell + 1e-9) {
                    ASSERT_TRUE(std::isfinite(row(ell)));
                    ASSERT_GE(row(ell), 0) << g << ' ' << ell << ' ' << cosine;
                }
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
