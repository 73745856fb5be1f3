// The droplets of [Bouthors2006] in three wavelengths, against values computed elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "bake/mie/droplet_optics.h"
#include "bake/mie/forward_peak.h"
#include "bake/mie/phase_texture.h"
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

TEST(PaperDroplets, PhaseFunctionIntegratesTo1WithTheMeanCosineOfTheCoefficients) {
    for (const double nm : {650.0, 550.0, 450.0}) {
        const DropletOptics& optics = paper_optics(nm);
        EXPECT_NEAR(integrate_table(optics.phase), 1, 1e-12) << nm;
        EXPECT_NEAR(optics.integral_before, 1, 1e-4) << nm;
        EXPECT_NEAR(integrate_cosine(optics.phase), optics.g, 1e-4) << nm;
    }
}

// kappa = 3/4 Q LWC / (rho r_e) whatever the droplets; [Bouthors2006] states N0 pi r_e^2, 25 %
// more.
TEST(PaperDroplets, ExtinctionFollowsFromTheLiquidWater) {
    const DropletDistribution d = paper_droplets();
    const DropletOptics& optics = paper_optics(550);
    const double kappa = extinction(d, optics);
    const double efficiency = optics.c_ext / optics.c_geo;
    EXPECT_NEAR(0.75 * efficiency * liquid_water_content(d) / (1000 * d.effective_radius) / kappa,
                1, 1e-12);
    const double paper = d.density * pi * d.effective_radius * d.effective_radius;
    EXPECT_NEAR(paper / kappa, 1.25, 0.01);
}

/// The angle of the largest (sign 1) or smallest (sign -1) value between two angles [degrees].
double extremum(const AngularTable& phase, double from, double to, int sign) {
    double best = from;
    for (std::size_t i = 0; i < phase.angle.size(); ++i) {
        const double angle = phase.angle[i] / kDegree;
        if (angle > from && angle < to &&
            sign * phase.value[i] > sign * eval_table(phase, best * kDegree)) {
            best = angle;
        }
    }
    return best;
}

TEST(PaperDroplets, FogbowStandsAt142DegreesAndTheDarkRingAt104) {
    struct Bow {
        double nm, angle, value, least;
    };
    for (const Bow bow : {Bow{650, 142.2, 0.280, 0.0281},
                          {550, 142.0, 0.295, 0.0260},
                          {450, 142.1, 0.316, 0.0243}}) {
        const AngularTable& phase = paper_optics(bow.nm).phase;
        const double bright = extremum(phase, 130, 155, 1), dark = extremum(phase, 90, 120, -1);
        EXPECT_NEAR(bright, bow.angle, 0.5) << bow.nm;
        EXPECT_NEAR(kSphere * eval_table(phase, bright * kDegree), bow.value, 0.03 * bow.value);
        EXPECT_NEAR(dark, 104, 3) << bow.nm;
        EXPECT_NEAR(kSphere * eval_table(phase, dark * kDegree), bow.least, 0.03 * bow.least);
    }
}

TEST(PaperDroplets, GloryIsARingThatShrinksWithTheWavelength) {
    double last = 0;
    for (const auto& [nm, angle] : {std::pair{650.0, 177.80}, {550.0, 178.18}, {450.0, 178.44}}) {
        const AngularTable& phase = paper_optics(nm).phase;
        const double ring = extremum(phase, 176.5, 178.9, 1);
        EXPECT_NEAR(ring, angle, 0.05) << nm;
        EXPECT_GT(ring, last);
        last = ring;
        // Brighter than around it, and the centre is a spot.
        EXPECT_GT(eval_table(phase, ring * kDegree), 1.5 * eval_table(phase, 174 * kDegree));
        EXPECT_GT(eval_table(phase, pi), eval_table(phase, ring * kDegree));
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

// A few hundred rows hold the peak, the fogbow and the glory.
TEST(PaperDroplets, RowsCrowdWhereThePhaseFunctionBends) {
    const AngularTable& phase = paper_optics(550).phase;
    const AngularTable thin = thin_table(phase, 0.002);
    EXPECT_LT(thin.angle.size(), 400u);
    const auto rows_between = [&](double from, double to) {
        return std::count_if(thin.angle.begin(), thin.angle.end(), [&](double angle) {
            return angle >= from * kDegree && angle < to * kDegree;
        });
    };
    EXPECT_GT(rows_between(0, 5), 4 * rows_between(60, 65));
    EXPECT_NEAR(integrate_table(thin), 1, 2e-3);
    EXPECT_NEAR(integrate_cosine(thin), paper_optics(550).g, 2e-3);
}

}  // namespace
}  // namespace opaline::bake
