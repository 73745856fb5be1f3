
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

// Henyey and Greenstein's, with a peak that 16 streams do not resolve.
TEST(OnceFluxes, AreTheFirstOrderOfTheSolver) {
    for (const double g : {0.0, 0.5, 0.9}) {
        SlabMedium medium{{}, 0.9};
        for (int l = 0; l < 60; ++l) {
            medium.moment.push_back(std::pow(g, l));
        }
        const std::vector<double> depths{0, 0.01, 1, 20}, cosines{1e-6, 0.1, 0.5, 1};
        const std::vector<OnceFluxes> once = scatter_once(medium, depths, cosines, 16);
        for (std::size_t d = 0; d < depths.size(); ++d) {
            SlabRequest request;
            request.optical_depth = depths[d];
            request.cosine = cosines;
            request.streams = 16;
            request.orders = 2;
            const SlabFluxes expected = solve_slab(medium, request).front().order[1];
            for (std::size_t i = 0; i < cosines.size(); ++i) {
                EXPECT_NEAR(once[d].reflected[i], expected.reflectance[i], 1e-8);
                EXPECT_NEAR(once[d].transmitted[i], expected.transmittance[i], 1e-8);
            }
        }
    }
}

}  // namespace
}  // namespace opaline::bake
