#include "bake/calibration/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/calibration/dented_ball.h"
#include "bake/scene/orient_bodies.h"

namespace opaline::bake {
namespace {

TEST(Calibration, EveryRateOfThisMachineIsATimeThatPasses) {
    const Rates rates = measure_rates(2);
    visit_rates(rates, [](const char* name, double rate) {
        EXPECT_TRUE(std::isfinite(rate)) << name;
        EXPECT_GE(rate, 0) << name;  // a rate from a difference of two times may be 0
    });
    EXPECT_GT(rates.test_lights, 0);
    EXPECT_GT(rates.coherent_ray.at(1e5), 0);
    EXPECT_GT(rates.look_up.at(1e5), 0);
    EXPECT_GE(rates.crowding, 1);
}

TEST(DentedBall, IsClosedAndFacesOutward) {
    const formats::Scene scene = make_dented_ball(16);
    const formats::Primitive& p = scene.primitives[0];
    EXPECT_EQ(static_cast<double>(p.index.size() / 3), CostBySize::kFew);
    const OrientedBodies bodies = orient_bodies(scene);
    EXPECT_FALSE(bodies.scene);  // nothing was turned
    ASSERT_EQ(bodies.surfaces.size(), 1u);
    EXPECT_EQ(bodies.surfaces[0].open_edges, 0u);
    for (std::size_t v = 0; v < p.position.size(); ++v) {
        EXPECT_GT(glm::length(p.position[v]), 0.8f);
        EXPECT_LT(glm::length(p.position[v]), 1.2f);
        EXPECT_GT(glm::dot(p.position[v], p.normal[v]), 0);
    }
}

}  // namespace
}  // namespace opaline::bake
