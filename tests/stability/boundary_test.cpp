#include <gtest/gtest.h>

#include <cmath>

#include "bake/physics/fresnel.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Rgb;
using tests::all_finite;
using tests::bake_scene;
using tests::make_grey_medium;
using tests::relative_rms;
using tests::relight_primitive;
using tests::small_bake;

BakeResult bake_ball(float eta) {
    return bake_scene(
        tests::make_translucent_scene({tests::make_sphere(2)}, make_grey_medium(20, 0.2f, eta)),
        small_bake());
}

TEST(Boundary, IndexOfOneIsTheLimitOfIndicesBesideIt) {
    const auto one = relight_primitive(bake_ball(1).asset, "studio");
    for (const float eta : {0.9999f, 0.999999f, 1.000001f, 1.0001f}) {
        EXPECT_LT(relative_rms(relight_primitive(bake_ball(eta).asset, "studio"), one), 4e-3)
            << eta;
    }
}

TEST(Boundary, IndicesFromAThirdToThreeGiveSoundRows) {
    for (const float eta : {1.0f / 3, 0.5f, 0.8f, 2.0f, 3.0f}) {
        const BakeResult result = bake_ball(eta);
        EXPECT_TRUE(all_finite(result.asset)) << eta;
        double mean = 0;
        for (const Rgb c : relight_primitive(result.asset, "white")) {
            ASSERT_GE(c.g, 0) << eta;
            mean += c.g / 162.0;
        }
        // Seen along the normal, where most light leaves: up to Ft(1) / (1 - F_ext) of the mean.
        EXPECT_GT(mean, 0.01) << eta;
        EXPECT_LT(mean, 1.1 * fresnel_transmittance(1, eta) / (1 - fresnel_moments(eta).external))
            << eta;
    }
}

}  // namespace
}  // namespace opaline::bake
