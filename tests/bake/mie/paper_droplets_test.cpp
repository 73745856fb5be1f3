// The droplets of [Bouthors2006] in three wavelengths, against values computed elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/phase_texture.h"
#include "tests/bake/mie/mie_support.h"
#include "tests/support/cloud_table.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

using tests::CloudRow;
using tests::kDegree;
using tests::kSphere;
using tests::paper_droplets;
using tests::paper_optics;

/// The wavelength's own index where the row states none.
const DropletOptics& optics_of(const CloudRow& row) {
    const double nm = row.number("lambda_nm");
    const std::complex<double> water = tests::water_at(nm);
    return paper_optics(nm,
                        {row.number_or("m_re", water.real()), row.number_or("m_im", water.imag())});
}

TEST(PaperDroplets, CrossSectionsAndWeightsAreThoseOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "dsd");
    for (const auto& row : rows) {
        ASSERT_EQ(row.text("case"), "paperDSD") << row.name();
        const DropletOptics& optics = optics_of(row);
        const std::string& name = row.text("quantity");
        const double angle = row.number_or("theta_deg", 0) * kDegree;
        const double value = name == "Qext_eff"              ? optics.c_ext / optics.c_geo
                             : name == "Qsca_eff"            ? optics.c_sca / optics.c_geo
                             : name == "g"                   ? optics.g
                             : name == "Cext_um2"            ? optics.c_ext * 1e12
                             : name == "Cgeo_um2"            ? optics.c_geo * 1e12
                             : name == "kappa_per_m"         ? extinction(paper_droplets(), optics)
                             : name == "one_minus_albedo"    ? absorbed_share(optics)
                             : name == "weight_within_theta" ? integrate_within(optics.phase, angle)
                                                             : std::nan("");
        EXPECT_NEAR(value, row.value(), row.error()) << row.name();
    }
}

TEST(PaperDroplets, PhaseFunctionIsThatOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "phase");
    for (const auto& row : rows) {
        ASSERT_EQ(row.text("case"), "paperDSD") << row.name();
        ASSERT_EQ(row.text("quantity"), "P_4pi") << row.name();
        const double p = eval_table(optics_of(row).phase, row.number("theta_deg") * kDegree);
        EXPECT_NEAR(kSphere * p, row.value(), row.error()) << row.name();
    }
}

TEST(PaperDroplets, LightScatteredInThePeakIsThatOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "forward_peak");
    std::map<std::pair<double, double>, std::pair<PeakSplit, std::vector<double>>> peaks;
    for (const auto& row : rows) {
        ASSERT_EQ(row.text("quantity"), "W_F_4pi") << row.name();
        ASSERT_EQ(row.text("case").rfind("P_F cut ", 0), 0u) << row.name();
        const double cut = std::stod(row.text("case").substr(8));
        auto& [split, moments] = peaks[{row.number("lambda_nm"), cut}];
        if (moments.empty()) {
            split = split_peak(optics_of(row).phase, cut * kDegree);
            moments = table_moments(split.peak, kGlowMoments);
        }
        const double glow =
            forward_glow(split, moments, row.number("tau"), row.number("theta_deg") * kDegree);
        EXPECT_NEAR(kSphere * glow, row.value(), row.error()) << row.name();
    }
}

TEST(PaperDroplets, NumericalErrorIsReportedAndBelowHalfAPercent) {
    for (const double nm : {650.0, 550.0, 450.0}) {
        const DropletOptics& optics = paper_optics(nm);
        EXPECT_GT(optics.error.phase_rms, 1e-4) << nm;
        EXPECT_LT(optics.error.phase_rms, 5e-3) << nm;
        EXPECT_LT(optics.error.c_ext, 2e-4) << nm;
        EXPECT_LT(optics.error.g, 2e-4) << nm;
    }
}

TEST(PaperDroplets, PeakEndsAtFiveDegreesInGreen) {
    EXPECT_NEAR(find_peak_angle(paper_optics(550).phase) / kDegree, 5, 0.1);
    const PeakSplit split = split_peak(paper_optics(550).phase, 5 * kDegree);
    EXPECT_NEAR(split.weight, 0.455, 1e-3);
    EXPECT_NEAR(integrate_cosine(split.rest), 0.7316, 1e-3);
    // The paper states 51 %, which is the weight within nine degrees.
    EXPECT_NEAR(integrate_within(paper_optics(550).phase, 9 * kDegree), 0.51, 5e-3);
}

// Printed values for this distribution: integral 4 pi, P_2(0) = 7.61, P_2(180) = 0.525, least
// 0.2015.
TEST(PaperDroplets, TwoScatteringsByTheRestAreKnownAndPositive) {
    const AngularTable& phase = paper_optics(550).phase;
    const PeakSplit split = split_peak(phase, 5 * kDegree);
    const SelfConvolution twice =
        convolve_with_itself(split.rest, kConvolutionMoments, phase.angle);
    EXPECT_GT(twice.lowest, 0);
    EXPECT_NEAR(twice.integral, 1, 1e-5);
    EXPECT_NEAR(kSphere * eval_table(twice.table, 0), 7.61, 0.02);
    EXPECT_NEAR(kSphere * eval_table(twice.table, pi), 0.525, 0.005);
    EXPECT_NEAR(kSphere * twice.lowest, 0.2015, 0.001);
    const SelfConvolution more = convolve_with_itself(split.rest, 1800, phase.angle);
    const SelfConvolution fewer = convolve_with_itself(split.rest, 400, phase.angle);
    // The image of the edge at theta_f is a cusp straight ahead, where the series converges
    // slowest.
    double ahead = 0, elsewhere = 0, of_fewer = 0;
    for (std::size_t i = 0; i < phase.angle.size(); ++i) {
        const double value = more.table.value[i];
        const double error = std::abs(twice.table.value[i] / value - 1);
        (phase.angle[i] < 0.15 * kDegree ? ahead : elsewhere) =
            std::max(phase.angle[i] < 0.15 * kDegree ? ahead : elsewhere, error);
        of_fewer = std::max(of_fewer, std::abs(fewer.table.value[i] / value - 1));
    }
    EXPECT_LT(ahead, 3e-3);
    EXPECT_LT(elsewhere, 7e-4);
    EXPECT_GT(of_fewer, ahead);
}

TEST(PaperDroplets, TextureOf256TexelsErrsByLessThan2Percent) {
    const AngularTable& phase = paper_optics(550).phase;
    double last = 1;
    for (const auto& [texels, bound] : {std::pair{256u, 0.02}, {1024u, 0.012}}) {
        const PhaseTexture texture = make_phase_texture(phase, texels);
        EXPECT_NEAR(texture.integral, 1, 1e-3) << texels;
        double error = 0;
        for (std::size_t i = 0; i < phase.angle.size(); ++i) {
            error = std::max(error,
                             std::abs(eval_texture(texture, phase.angle[i]) / phase.value[i] - 1));
        }
        EXPECT_LT(error, bound) << texels;
        EXPECT_LT(error, last) << texels;
        last = error;
    }
}

}  // namespace
}  // namespace opaline::bake
