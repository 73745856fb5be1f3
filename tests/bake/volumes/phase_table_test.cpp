#include "bake/effects/volumes/phase_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/physics/phase.h"
#include "bake/trace/density/scaled_phase.h"
#include "formats/opal/phase_table.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/support/cut_phase.h"

namespace opaline::bake {
namespace {

using formats::eval_phase_table;
using formats::integrate_phase_table;
using formats::kPhaseEntries;

// The largest relative error over all angles, every 0.02 degrees.
template <class Exact>
double worst_error(const std::vector<float>& table, Exact exact) {
    double worst = 0;
    for (int i = 0; i <= 9000; ++i) {
        const double c = std::cos(i * std::numbers::pi / 9000);
        const double found = static_cast<double>(eval_phase_table(table, static_cast<float>(c)));
        worst = std::max(worst, std::abs(found / exact(c) - 1));
    }
    return worst;
}

TEST(PhaseTableOfVolumes, IntegratesToOne) {
    for (const float g : {-0.95f, -0.5f, 0.0f, 0.3f, 0.5f, 0.75f, 0.85f, 0.95f, 0.99f}) {
        const formats::PhaseFunction phase = tests::hg(g);
        const std::vector<float> table = tabulate_phase(phase, scale_phase(phase).peak);
        ASSERT_EQ(table.size(), kPhaseEntries);
        EXPECT_NEAR(integrate_phase_table(table), 1, 1e-6) << g;
        EXPECT_GE(*std::ranges::min_element(table), 0);
    }
}

// The share g^5 is the peak that the bake takes out; what is above the cut must be just that.
TEST(PhaseTableOfVolumes, IsHenyeyGreensteinBelowTheCutThatLeavesThePeak) {
    for (const double g : {0.5, 0.75, 0.85, 0.95}) {
        const formats::PhaseFunction phase = tests::hg(g);
        const double peak = scale_phase(phase).peak;
        const tests::CutPhase exact = tests::make_cut_phase(g);
        ASSERT_NEAR(peak, exact.peak, 1e-6);
        const std::vector<float> table = tabulate_phase(phase, peak);
        // Rounded off at the edge, where the slope changes at once.
        EXPECT_LT(worst_error(table, exact), 0.03) << g;
        double worst = 0;
        for (int i = 0; i <= 3600; ++i) {
            const double angle = i * std::numbers::pi / 3600, c = std::cos(angle);
            if (std::abs(angle - std::acos(exact.edge)) < 0.02) continue;
            const auto found = static_cast<double>(eval_phase_table(table, static_cast<float>(c)));
            worst = std::max(worst, std::abs(found / exact(c) - 1));
        }
        EXPECT_LT(worst, 3e-3) << g;
    }
}

TEST(PhaseTableOfVolumes, IsThePhaseFunctionItselfWithoutAPeak) {
    for (const double g : {-0.85, -0.4, 0.3}) {
        const formats::PhaseFunction phase = tests::hg(g);
        ASSERT_EQ(scale_phase(phase).peak, 0);
        EXPECT_LT(worst_error(tabulate_phase(phase, 0),
                              [&](double c) { return henyey_greenstein(c, phase.g); }),
                  0.006)
            << g;
    }
    EXPECT_LT(worst_error(tabulate_phase(tests::rayleigh(), 0),
                          [](double c) { return 3 * (1 + c * c) / (16 * std::numbers::pi); }),
              2e-4);
    EXPECT_LT(worst_error(tabulate_phase({}, 0), [](double) { return 0.25 / std::numbers::pi; }),
              1e-6);
}

// A ring 0.15 degrees wide, much less than a step, and as wide a forward peak.
TEST(PhaseTableOfVolumes, NarrowPeaksKeepTheirLight) {
    for (const double angle : {0.0, 42.3, 137.9}) {
        const auto cosine = [&](double degrees) {
            return static_cast<float>(std::cos((angle + degrees) * std::numbers::pi / 180));
        };
        const formats::PhaseFunction phase =
            angle > 0
                ? tests::table_of({-1, cosine(0.15), cosine(0.075), cosine(0), 1}, {0, 0, 1, 0, 0})
                : tests::table_of({-1, cosine(0.15), 1}, {0, 0, 1});
        const std::vector<float> table = tabulate_phase(phase, 0);
        EXPECT_NEAR(integrate_phase_table(table), 1, 1e-6);
        const double coordinate = static_cast<double>(formats::phase_coordinate(cosine(0.075)));
        for (std::size_t i = 0; i < kPhaseEntries; ++i) {
            if (std::abs(static_cast<double>(i) - coordinate) > 1.2) {
                EXPECT_EQ(table[i], 0) << angle << " entry " << i;
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
