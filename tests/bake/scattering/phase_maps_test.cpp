#include "bake/physics/phase_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bake/physics/phase.h"
#include "bake/physics/phase_series.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/scattering/table_support.h"

namespace opaline::bake {
namespace {

using formats::PhaseFunction;
using tests::gaussian;
using tests::hg;
using tests::rayleigh;

constexpr unsigned kSize = 16;

formats::Vec3 direction(std::size_t texel, unsigned size) {
    const auto i = static_cast<std::uint32_t>(texel);
    return formats::texel_direction(size, i / (size * size), i / size % size, i % size);
}

double entry(const PhaseMaps& maps, std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t k = 0; k < maps.g.size(); ++k) {
        sum += maps.g[k][a] * maps.h[k][b];
    }
    return sum;
}

double cosine(std::size_t a, std::size_t b, unsigned size) {
    return std::clamp(-double(formats::dot(direction(a, size), direction(b, size))), -1.0, 1.0);
}

TEST(PhaseMaps, SingularValuesAndErrorsAreThoseOfTheTable) {
    using Row = tests::ReferenceRow;
    std::map<double, PhaseMaps> known;
    const auto maps = [&](const Row& row) -> const PhaseMaps& {
        const double g = row.number("g");
        const auto p = [g](double x) { return henyey_greenstein(x, g); };
        auto found = known.find(g);
        if (found == known.end()) {
            found = known.emplace(g, factor_phase(p, kSize, 0)).first;
        }
        return found->second;
    };
    tests::expect_rows("hg_svd_cube16_sv", [&](const Row& row) {
        return maps(row).singular_value[static_cast<std::size_t>(row.number("index"))];
    });
    tests::expect_rows("hg_svd_cube16_rms_rel", [&](const Row& row) {
        return phase_rms_relative(maps(row), static_cast<unsigned>(row.number("K")));
    });
}

TEST(PhaseMaps, AllTermsGiveTheFunctionBack) {
    constexpr unsigned kSmall = 4;
    for (const PhaseFunction& phase : {hg(0.6), hg(-0.3), rayleigh(), gaussian(0.5)}) {
        const PhaseDensity density = make_phase_density(phase);
        const PhaseMaps maps = factor_phase(phase, kSmall, formats::cubemap_texels(kSmall));
        for (std::size_t a = 0; a < formats::cubemap_texels(kSmall); ++a) {
            for (std::size_t b = 0; b < formats::cubemap_texels(kSmall); ++b) {
                const double p = eval_phase(density, cosine(a, b, kSmall));
                // texel_direction is in single precision.
                ASSERT_NEAR(entry(maps, a, b), p, 1e-5) << a << " " << b;
            }
        }
    }
}

TEST(PhaseMaps, ViewMapsAreOrthonormalOnTheSphere) {
    const PhaseMaps maps = factor_phase(hg(0.5), kSize, 25);
    const std::vector<double> solid_angle = formats::texel_solid_angles(kSize);
    for (std::size_t j = 0; j < 25; ++j) {
        for (std::size_t k = 0; k <= j; ++k) {
            double sum = 0;
            for (std::size_t i = 0; i < maps.h[j].size(); ++i) {
                sum += maps.h[j][i] * maps.h[k][i] * solid_angle[i % solid_angle.size()];
            }
            EXPECT_NEAR(sum, j == k ? 1 : 0, 1e-12) << j << " " << k;
        }
    }
}

TEST(PhaseMaps, FirstTermIsConstantAndFirstLargestValuesArePositive) {
    const PhaseMaps maps = factor_phase(hg(-0.6), kSize, 25);
    for (const double h : maps.h[0]) {
        // 1 / sqrt(4 pi), about as exact as the rows' integrals of 1.
        EXPECT_NEAR(h, 0.28209479, maps.row_error);
    }
    for (const auto& h : maps.h) {
        double largest = 0;
        for (const double value : h) {
            largest = std::max(largest, std::abs(value));
        }
        const auto first = std::find_if(h.begin(), h.end(), [&](double value) {
            return std::abs(value) >= (1 - 1e-6) * largest;
        });
        EXPECT_GT(*first, 0);
    }
}

// Rounding must not choose a basis within a multiplet: a relative change of g by 1e-7, hardly more
// than rounding, hardly changes any map.
TEST(PhaseMaps, MapsOfAMultipletAreDetermined) {
    const PhaseMaps a = factor_phase(hg(0.4), kSize, 25),
                    b = factor_phase(hg(0.40000004), kSize, 25);
    for (std::size_t k = 0; k < 25; ++k) {
        for (std::size_t i = 0; i < a.h[k].size(); ++i) {
            ASSERT_NEAR(a.h[k][i], b.h[k][i], 1e-4) << k << " " << i;
        }
    }
}

TEST(PhaseMaps, RowErrorTellsOfPeaksThatTexelsMiss) {
    EXPECT_LT(factor_phase(hg(0.6), kSize, 0).row_error, 1e-3);
    // Point samples miss the peak: row sums of 1.02 at g = 0.9 and 1.46 at 0.95.
    EXPECT_NEAR(factor_phase(hg(0.9), kSize, 0).row_error, 0.02, 0.005);
    EXPECT_NEAR(factor_phase(hg(0.95), kSize, 0).row_error, 0.46, 0.005);
}

}  // namespace
}  // namespace opaline::bake
