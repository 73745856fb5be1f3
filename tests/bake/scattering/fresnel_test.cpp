#include "bake/scattering/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/scattering/gauss_legendre.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

TEST(Fresnel, TransmittanceIsThatOfTheTable) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "fresnel_T");
    for (const auto& row : rows) {
        EXPECT_NEAR(fresnel_transmittance(row.number("cos_i"), row.number("eta")), row.expected,
                    row.tolerance())
            << row.name();
    }
}

TEST(Fresnel, RefractedCosineIsThatOfTheTable) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "refracted_cos");
    for (const auto& row : rows) {
        EXPECT_NEAR(refracted_cosine(row.number("cos_i"), row.number("eta")), row.expected,
                    row.tolerance())
            << row.name();
    }
}

TEST(Fresnel, MomentsAreThoseOfTheTable) {
    OPALINE_REFERENCE_ROWS(f_dr, "translucency.csv", "Fdr_exact");
    OPALINE_REFERENCE_ROWS(c2, "translucency.csv", "C2x3_exact");
    OPALINE_REFERENCE_ROWS(f_ext, "translucency.csv", "Fext_exact");
    OPALINE_REFERENCE_ROWS(fit, "translucency.csv", "Fdr_fit");
    for (const auto& row : f_dr) {
        EXPECT_NEAR(fresnel_moments(row.number("eta")).diffuse_internal(), row.expected,
                    row.tolerance())
            << row.name();
    }
    for (const auto& row : c2) {
        EXPECT_NEAR(3 * fresnel_moments(row.number("eta")).c2, row.expected, row.tolerance())
            << row.name();
    }
    for (const auto& row : f_ext) {
        EXPECT_NEAR(fresnel_moments(row.number("eta")).external, row.expected, row.tolerance())
            << row.name();
    }
    for (const auto& row : fit) {
        EXPECT_NEAR(fitted_diffuse_reflectance(row.number("eta")), row.expected, row.tolerance())
            << row.name();
    }
}

TEST(Fresnel, SameFromBothSidesOfTheBoundary) {
    for (const double eta : {0.4, 0.8, 1.0, 1.000001, 1.3, 2.5}) {
        for (const double cosine : {1.0, 0.7, 0.3, 0.01}) {
            const double inside = refracted_cosine(cosine, eta);
            if (inside == 0) continue;
            EXPECT_NEAR(fresnel_transmittance(cosine, eta), fresnel_transmittance(inside, 1 / eta),
                        1e-10);
        }
    }
}

TEST(Fresnel, MomentsOfBothSidesObeyReciprocity) {
    for (const double eta : {0.34, 0.7, 1.001, 1.2, 1.7, 3.0}) {
        const FresnelMoments m = fresnel_moments(eta);
        EXPECT_NEAR(m.diffuse_internal(), 1 - (1 - m.external) / (eta * eta), 1e-8) << eta;
    }
}

TEST(Fresnel, EveryAngleAndIndexGivesAShare) {
    for (const double eta : {1e-3, 0.5, 1.0, 1.0 + 1e-12, 4.0, 1e3}) {
        for (const double cosine : {0.0, 1e-300, 1e-12, 0.5, 1.0, 1.0 + 1e-15}) {
            const double t = fresnel_transmittance(cosine, eta);
            EXPECT_TRUE(t >= 0 && t <= 1 + 1e-12) << eta << " " << cosine << " " << t;
        }
    }
    EXPECT_EQ(fresnel_transmittance(0.1, 0.8), 0) << "total reflection";
    EXPECT_EQ(fresnel_transmittance(0.0, 1.0), 1) << "no boundary";
}

TEST(GaussLegendre, IntegratesPolynomialsOfTwiceItsSizeExactly) {
    for (const int n : {1, 2, 8, 64}) {
        const GaussLegendre rule = make_gauss_legendre(n);
        for (int power = 0; power < 2 * n; ++power) {
            double sum = 0;
            for (std::size_t i = 0; i < rule.node.size(); ++i) {
                sum += rule.weight[i] * std::pow(rule.node[i], power);
            }
            EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-14) << n << " " << power;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
