#include "runtime/volumes/moment_lights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/volumes/texel_integrals.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::runtime {
namespace {

std::vector<LightVector> moments_of(const LightVector& light, std::uint32_t count,
                                    unsigned threads = 0) {
    return make_moment_lights(texel_integrals(light), light.n, count, threads);
}

TEST(MomentLights, WhiteLightHasOnlyAMean) {
    const auto moments = moments_of(test::white_light(16), 25);
    ASSERT_EQ(moments.size(), 25u);
    EXPECT_NEAR(tests::flux(moments[0], 0), std::sqrt(4 * std::numbers::pi), 1e-5);
    for (std::size_t k = 1; k < 25; ++k) {
        // Degree 4 has the cube's symmetry: there centres of texels err by their size squared.
        EXPECT_NEAR(tests::flux(moments[k], 0), 0, k < 16 ? 1e-5 : 8e-3) << k;
    }
}

TEST(MomentLights, OfATexelAreTheHarmonicsOfItsCentre) {
    constexpr std::uint32_t n = 8, texel = 2 * n * n + 3 * n + 6;
    const LightVector light = test::texel_light(n, texel, {2, 3, 5});
    const auto moments = moments_of(light, 25);
    std::array<float, 25> expected{};
    formats::eval_spherical_harmonics(formats::texel_direction(n, 2, 3, 6), expected);
    for (std::size_t band = 0; band < 3; ++band) {
        const double whole = tests::flux(light, band);
        EXPECT_GT(whole, 0);
        for (std::size_t k = 0; k < 25; ++k) {
            EXPECT_NEAR(tests::flux(moments[k], band), expected[k] * whole, 1e-6 * whole) << k;
            EXPECT_NEAR(tests::texels_of(moments[k], band)[texel], expected[k] * whole,
                        1e-6 * whole);
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
