#include <gtest/gtest.h>

#include <cmath>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/scattering_color.h"
#include "formats/gltf/map_medium.h"
#include "tests/bake/scattering/table_support.h"

namespace opaline::bake {
namespace {

TEST(Fresnel, SharesAnglesAndMomentsAreThoseOfTheTable) {
    using Row = tests::ReferenceRow;
    tests::expect_rows("fresnel_T", [](const Row& row) {
        return fresnel_transmittance(row.number("cos_i"), row.number("eta"));
    });
    tests::expect_rows("refracted_cos", [](const Row& row) {
        return refracted_cosine(row.number("cos_i"), row.number("eta"));
    });
    tests::expect_rows("Fdr_exact", [](const Row& row) {
        return fresnel_moments(row.number("eta")).diffuse_internal();
    });
    tests::expect_rows("C2x3_exact",
                       [](const Row& row) { return 3 * fresnel_moments(row.number("eta")).c2; });
    tests::expect_rows("Fext_exact",
                       [](const Row& row) { return fresnel_moments(row.number("eta")).external; });
    tests::expect_rows(
        "Fdr_fit", [](const Row& row) { return fitted_diffuse_reflectance(row.number("eta")); });
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

// glTF's drafts print the inversion with constants of six digits.
TEST(ScatteringColor, AlbedoIsThatOfTheInversionWhichGltfsDraftsPrint) {
    for (const double g : {-0.5, 0.0, 0.8}) {
        for (double color = 0.02; color <= 1; color += 0.02) {
            EXPECT_NEAR(albedo_of_color(color, g),
                        formats::gltf::single_scattering_albedo(color, g), 2e-5)
                << color << ' ' << g;
        }
    }
}

TEST(ScatteringColor, ColorAndAlbedoAreInversesUpToTheLastDigits) {
    for (const double g : {-0.9, 0.0, 0.9}) {
        for (const double albedo : {0.0, 1e-3, 0.3, 0.9, 0.999, 0.9999999, 1.0}) {
            const double color = scattering_color(albedo, g);
            EXPECT_GE(color, 0);
            EXPECT_LE(color, 1);
            EXPECT_NEAR(1 - albedo_of_color(color, g), 1 - albedo, 1e-12 + 1e-7 * (1 - albedo))
                << albedo << ' ' << g;
        }
        EXPECT_EQ(albedo_of_color(0, g), 0);
        EXPECT_EQ(albedo_of_color(1, g), 1);
    }
}

}  // namespace

}  // namespace opaline::bake
