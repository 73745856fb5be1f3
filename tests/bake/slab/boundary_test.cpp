// Slabs behind smooth boundaries that reflect and refract.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/physics/fresnel.h"
#include "bake/physics/slab/slab_walk.h"
#include "tests/bake/slab/slab_support.h"

namespace opaline::tests {
namespace {

using bake::SlabMedium;
using bake::SlabSolution;

SlabSolution solve_behind(const SlabMedium& medium, double eta, double depth, double cosine,
                          unsigned orders = 0, int streams = 48) {
    bake::SlabRequest request{depth, 0, {cosine}, streams, orders};
    request.eta = eta;
    return solve_slab(medium, request).front();
}

// Index 1.5, albedo .9, isotropic: .2600 along the normal by [Giovanelli1955]. It is 0.25992 with
// 48 streams and with 160, so the last digit printed is one too high.
TEST(SlabBoundary, ThickSlabReflectsAsGiovanellisHalfSpace) {
    const SlabSolution slab = solve_behind({{1.0}, 0.9}, 1.5, 100, 1, 0, 160);
    EXPECT_NEAR(slab.total.reflectance[0], 0.2600, 1e-4);
    // At the critical cosine the light bends like a root: fewer streams converge slowly there.
    const SlabSolution coarse = solve_behind({{1.0}, 0.9}, 1.5, 100, 1);
    EXPECT_NEAR(coarse.total.reflectance[0], slab.total.reflectance[0], 2e-5);
    EXPECT_NEAR(slab.total.transmittance[0], 0, 1e-12);
}

// Both faces of a clear plate, all reflections between them: 2 F / (1 + F).
TEST(SlabBoundary, ClearPlateReflectsByFresnelAlone) {
    for (const double eta : {0.7, 1.0 + 1e-9, 1.5, 2.5}) {
        for (const double cosine : {1.0, 0.8, 0.1}) {
            const double f = bake::fresnel_reflectance(cosine, eta);
            for (const double depth : {0.0, 1e-12}) {
                const SlabSolution slab = solve_behind({{1.0}, 1}, eta, depth, cosine, 2, 8);
                EXPECT_NEAR(slab.total.reflectance[0], 2 * f / (1 + f), 1e-10) << eta << cosine;
                EXPECT_NEAR(slab.order[0].reflectance[0], 2 * f / (1 + f), 1e-8) << eta << cosine;
            }
        }
    }
    // An absorber: F + (1 - F)^2 F e^-2X / (1 - F^2 e^-2X)
    const double f = bake::fresnel_reflectance(0.6, 1.5),
                 e = std::exp(-1 / bake::refracted_cosine(0.6, 1.5));
    const SlabSolution black = solve_behind({{1.0}, 0}, 1.5, 1, 0.6);
    EXPECT_NEAR(black.total.reflectance[0], f + (1 - f) * (1 - f) * f * e * e / (1 - f * f * e * e),
                1e-12);
    EXPECT_NEAR(black.total.transmittance[0], (1 - f) * (1 - f) * e / (1 - f * f * e * e), 1e-12);
}

TEST(SlabBoundary, WithoutAbsorptionNothingIsLost) {
    for (const double eta : {1.0 / 3, 0.75, 1.33, 3.0}) {
        for (const double depth : {0.0, 1e-6, 0.1, 3.0, 300.0}) {
            for (const double cosine : {1e-3, 0.4, 1.0}) {
                const auto slab =
                    solve_behind(henyey_greenstein_slab(0.7, 1), eta, depth, cosine, 0, 16);
                EXPECT_NEAR(slab.total.reflectance[0] + slab.total.transmittance[0], 1, 1e-9)
                    << eta << " " << depth << " " << cosine;
                EXPECT_NEAR(slab.total.mean_reflectance + slab.total.mean_transmittance, 1, 1e-9)
                    << eta << " " << depth;
            }
        }
    }
}

TEST(SlabBoundary, IndexNearOneIsNoBoundary) {
    const SlabMedium medium = henyey_greenstein_slab(0.6, 0.9);
    const SlabSolution bare = solve_one(medium, 2, 0.5, 3);
    for (const double eta : {1 - 1e-8, 1 + 1e-8}) {
        const SlabSolution slab = solve_behind(medium, eta, 2, 0.5, 3);
        EXPECT_NEAR(slab.total.reflectance[0], bare.total.reflectance[0], 1e-6);
        EXPECT_NEAR(slab.total.transmittance[0], bare.total.transmittance[0], 1e-6);
        EXPECT_NEAR(slab.order[2].reflectance[0], bare.order[2].reflectance[0], 1e-6);
        EXPECT_NEAR(slab.total.mean_reflectance, bare.total.mean_reflectance, 1e-5);
    }
}

TEST(SlabBoundary, BeamsBeyondTheCriticalAngleStayOutside) {
    const SlabSolution slab = solve_behind({{1.0}, 0.5}, 0.7, 1, 0.5, 2);
    EXPECT_EQ(slab.total.reflectance[0], 1);
    EXPECT_EQ(slab.total.transmittance[0], 0);
}

TEST(SlabBoundary, ThinSlabsOfTrappedPhotonsEnd) {
    bake::SlabWalkRequest request{1e-9, 1, 0.5, 20000, 1};
    request.eta = 1.5;
    const auto walk = walk_slab(bake::CosineSampler::henyey_greenstein(0), request, {});
    EXPECT_NEAR(walk.reflectance.share + walk.transmittance.share, 1, 1e-12);
    request.optical_depth = 0.01;  // many are trapped, and leave at last
    const auto thicker = walk_slab(bake::CosineSampler::henyey_greenstein(0), request, {});
    EXPECT_NEAR(thicker.reflectance.share + thicker.transmittance.share, 1, 1e-12);
}

}  // namespace
}  // namespace opaline::tests
