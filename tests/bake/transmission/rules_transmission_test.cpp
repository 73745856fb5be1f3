#include "bake/effects/transmission/rules_transmission.h"

#include <cmath>

#include "bake/effects/transmission/view_fit.h"
#include "tests/bake/transmission/straight_body.h"

namespace opaline::bake {
namespace {

// Index 1: the mean of e^(-x c) under 2 c dc is 2 (1 - (1 + x) e^-x) / x^2.
TEST(StraightShare, OfAMatchedBallIsItsClosedForm) {
    EXPECT_NEAR(straight_share(1, 0), 1, 1e-12);
    for (const double x : {0.1, 1.0, 5.0, 30.0}) {
        EXPECT_NEAR(straight_share(1, x), 2 * (1 - (1 + x) * std::exp(-x)) / (x * x), 1e-9) << x;
    }
}

TEST(StraightShare, IsNoLessThanWhatABallShowsAndLittleMore) {
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        for (const float sigma_t : {0.1f, 1.0f, 3.0f}) {
            const auto ball = tests::make_crossed({tests::make_sphere(5)}, eta, sigma_t);
            const glm::vec3 normal = ball->scene.primitives[0].normal[17];
            const TransmissionViews views = spread_views(normal, eta, 256, {0.5f, 0.3f});
            const double shown = tests::mean_over(*ball, 0.9999f * normal, views);
            const double bound = straight_share(eta, 2 * double{sigma_t});
            // The ball is a polyhedron, its chords up to 0.5 % too short.
            EXPECT_LE(shown, bound * 1.02) << eta << ' ' << sigma_t;
            EXPECT_GE(shown, 0.75 * bound) << eta << ' ' << sigma_t;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
