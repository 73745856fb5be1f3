#include "bake/calibration/calibration.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "bake/calibration/bench/dented_ball.h"
#include "bake/effects/effects.h"
#include "bake/scene/orient_bodies.h"

namespace opaline::bake {
namespace {

// Differences of two measured times: on a busy machine the second may come out shorter.
const std::set<std::string> kDifferences{
    "shared_texel_few",  "shared_texel_many",  "look_up_few",   "look_up_many",
    "look_up_term",      "draw_pixel",         "draw_triangle", "sum_entry",
    "surface_point_few", "surface_point_many", "density_step",  "node_texel",
    "scattered_cell"};

// Seconds of one thread for one unit: more than a processor's cycle, less than the time in which a
// whole scene of such units is measured. A rate that nobody measures stays 0 and is found here.
TEST(Calibration, EveryRateOfThisMachineIsATimeThatPasses) {
    const Rates rates = measure_rates(all_effects(), 2);
    visit_rates(rates, [](const std::string& name, double rate) {
        if (name == "crowding" || name == "test_lights") return;
        EXPECT_LT(rate, 1e-2) << name;
        if (!kDifferences.contains(name)) {
            EXPECT_GT(rate, 1e-11) << name;
        }
    });
    EXPECT_GT(rates.test_lights, 1e-3) << "all of them";
    // A ray through sixteen times as many triangles takes about as long, not sixteen times.
    EXPECT_LT(rates.coherent_ray.many, 8 * rates.coherent_ray.few);
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
