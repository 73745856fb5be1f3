#include "bake/physics/slab/even_light.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/half_space_once.h"
#include "bake/physics/slab/slab_walk.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

double entering(double eta) {
    return 1 - fresnel_moments(eta).external;
}

// Of beams of eight cosines. Orders: what was never scattered, and the rest.
SlabShares walk_even_light(double albedo, double g, double eta, double thickness) {
    const GaussLegendre rule = make_gauss_legendre(8);
    SlabShares sum;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        SlabWalkRequest request{thickness, albedo, rule.node[i], 6000, i, 2};
        request.eta = eta;
        const SlabWalk walk = walk_slab(CosineSampler::henyey_greenstein(g), request, {});
        const double share = 2 * rule.node[i] * rule.weight[i];
        sum.back += share * walk.reflected_order[1].share;
        sum.through += share * walk.transmitted_order[1].share;
        sum.straight += share * (walk.reflected_order[0].share + walk.transmitted_order[0].share);
    }
    sum.straight -= fresnel_moments(eta).external;
    return sum;
}

TEST(HalfSpace, ReturnsTheReflectancesThatWereMeasuredIndependently) {
    // physics/README.md, "Half space": eta, albedo, single, multiple; standard error 0.001.
    const double rows[][4] = {{1.0, .80, .164, .178},
                              {1.3, .30, .0235, .0072},
                              {1.3, .80, .0629, .1188},
                              {1.3, .95, .0740, .3263},
                              {1.5, .80, .0411, .0893}};
    for (const auto& [eta, albedo, single, multiple] : rows) {
        const HalfSpaceReflectance r = half_space_reflectance(albedo, 0, eta);
        EXPECT_NEAR(r.once, single, 0.002) << eta << " " << albedo;
        EXPECT_NEAR(r.rest, multiple, 0.002) << eta << " " << albedo;
    }
}

TEST(HalfSpace, SingleScatteringPerAlbedoIsThatOfTheTable) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "ss_halfspace_reflectance_per_albedo");
    for (const auto& row : rows) {
        if (row.input.at("jac") != "exact") continue;
        // 32 nodes across the square root at the critical angle.
        EXPECT_NEAR(half_space_once(row.number("eta")), row.expected, 1e-4) << row.name();
    }
}

// At g = .99 some light goes deeper than the deepest slab.
TEST(HalfSpace, WithoutAbsorptionNothingIsLostAndNearItAsTheRootOfWhatIsAbsorbed) {
    for (const double eta : {1.0 / 3, 1.0, 1.3, 3.0}) {
        for (const double g : {-0.9, 0.0, 0.9, 0.99}) {
            const HalfSpaceReflectance r = half_space_reflectance(1, g, eta);
            EXPECT_NEAR(r.once + r.rest, entering(eta), g > 0.9 ? 2e-3 : 3e-4) << eta << " " << g;
            const auto lost = [&](double absorbed) {
                const HalfSpaceReflectance some = half_space_reflectance(1 - absorbed, g, eta);
                return entering(eta) - some.once - some.rest;
            };
            EXPECT_NEAR(lost(1e-6) / lost(1e-8), 10, g > 0.9 ? 3 : 1) << eta << " " << g;
        }
    }
}

TEST(Slab, ConservativeOneLosesNothingAndTransmitsByItsTransportThickness) {
    for (const double eta : {0.8, 1.0, 1.4}) {
        for (const double thickness : {0.0, 0.05, 1.0, 8.0}) {
            const SlabShares s = share_even_light(1, 0.5, eta, thickness);
            EXPECT_NEAR(s.back + s.through + s.straight, entering(eta), 1e-3)
                << eta << " " << thickness;
        }
    }
    // 4/3 / (tau' + 2 * 0.7104), asymptotic in tau'.
    for (const double g : {0.0, 0.8}) {
        const SlabShares s = share_even_light(1, g, 1, 8 / (1 - g));
        EXPECT_NEAR(s.through + s.straight, 4.0 / 3 / (8 + 1.4208), 0.003) << g;
    }
}

// In the limit each path is as likely to scatter as it is long, 2 tau in the mean, and half of that
// goes each way where the phase function is even.
TEST(Slab, ThinOneScattersInProportionToItsThicknessBothWaysAlike) {
    const SlabShares s = share_even_light(0.8, 0, 1, 0.01);
    const double seen = 2 * 0.8 * 0.01;
    EXPECT_NEAR(s.back, 0.5 * seen, 0.05 * seen);
    EXPECT_NEAR(s.through, 0.5 * seen, 0.05 * seen);
    EXPECT_NEAR(s.straight, 1 - 2 * 0.01, 0.002);
    const SlabShares forward = share_even_light(0.8, 0.9, 1, 0.01);
    EXPECT_GT(forward.through, 3 * forward.back);
}

// The photons' loop shares nothing with the solver; the peak of g = .99 and boundaries included.
TEST(Slab, SharesAreThoseOfPhotons) {
    for (const auto& [albedo, g, eta, thickness] :
         {std::array{0.9, 0.3, 1.3, 60.0}, std::array{0.99, 0.99, 1.5, 30.0},
          std::array{0.95, -0.8, 1.0, 2.0}}) {
        const SlabShares s = share_even_light(albedo, g, eta, thickness);
        const SlabShares walked = walk_even_light(albedo, g, eta, thickness);
        EXPECT_NEAR(s.back, walked.back, 4e-3) << g;
        EXPECT_NEAR(s.through, walked.through, 4e-3) << g;
        EXPECT_NEAR(s.straight, walked.straight, 4e-3) << g;
    }
}

TEST(Slab, ThickOneIsAHalfSpace) {
    const SlabShares s = share_even_light(0.9, 0.3, 1.3, 60),
                     half = share_even_light(0.9, 0.3, 1.3, kEndless);
    EXPECT_NEAR(s.back, half.back, 1e-6);
    EXPECT_LT(s.through + s.straight, 1e-3);
}

}  // namespace
}  // namespace opaline::bake
