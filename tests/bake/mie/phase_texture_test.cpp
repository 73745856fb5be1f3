#include "bake/physics/mie/phase_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/mie/droplet_optics.h"
#include "tests/bake/mie/mie_support.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

TEST(PhaseTexture, CoordinateIsTheInverseOfTheAngle) {
    EXPECT_EQ(texture_angle(0), 0);
    EXPECT_NEAR(texture_angle(1), pi, 1e-15);
    for (double u = 0; u <= 1; u += 1.0 / 512) {
        EXPECT_NEAR(texture_coordinate(texture_angle(u)), u, 1e-7) << u;
    }
    for (const double angle : {0.0, 1e-12, 1e-4, 1.0, pi - 1e-4, pi}) {
        EXPECT_NEAR(texture_angle(texture_coordinate(angle)), angle, 1e-12) << angle;
    }
}

TEST(PhaseTexture, IntegratesTo1AndStoresWhatItWasScaledBy) {
    const DropletOptics& optics = tests::fine_optics();
    for (const unsigned texels : {64u, 256u, 1024u}) {
        const PhaseTexture texture = make_phase_texture(optics.phase, texels);
        EXPECT_EQ(texture.log_value.size(), texels);
        double sum = 0;
        constexpr int kSteps = 20000;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = pi * (i + 0.5) / kSteps;
            sum += 2 * pi * std::sin(angle) * pi / kSteps * eval_texture(texture, angle);
        }
        EXPECT_NEAR(sum, 1, 1e-5) << texels;
        EXPECT_NEAR(texture.integral, 1, 20.0 / (texels * texels)) << texels;
    }
}

}  // namespace
}  // namespace opaline::bake
