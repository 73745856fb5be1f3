#include <gtest/gtest.h>

#include <cmath>

#include "bake/reference/reference_receivers.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

bake::Moments trace(const ReferenceFixture& body, bool by_sky, std::uint32_t samples) {
    const auto receivers = bake::choose_receivers(body.scene, 1, 3, std::nullopt);
    bake::Moments all;
    for (std::uint32_t s = 0; s < samples; ++s) {
        bake::RandomStream random(0, 0, s);
        const bake::PathSample path = bake::trace_receiver(body.space(), receivers[0], random);
        all.add(glm::dvec3(by_sky ? path.sky : path.radiance));
        if (path.sky != glm::vec3(0)) {
            EXPECT_NEAR(glm::length(path.to_sky), 1, 1e-5f);
        }
    }
    return all;
}

Scene make_ball(float eta) {
    Scene input = make_scene({make_sphere(2)});
    input.materials[0].medium = make_medium(3, 0.9f, 0.3f, eta);
    return input;
}

// Behind a boundary that refracts nothing else reaches the light: path by path.
TEST(SkyEnd, InTheDarkIsWorthWhatEvenLightAddsBehindARefractingBoundary) {
    const auto dark = make_fixture(make_ball(1.4f), {}),
               lit = make_fixture(make_ball(1.4f), make_white_sky());
    const bake::Moments weights = trace(*dark, true, 2000), light = trace(*lit, false, 2000);
    EXPECT_GT(light.mean.x, 0.1);
    EXPECT_NEAR(weights.mean.x, light.mean.x, 1e-6);
    EXPECT_EQ(trace(*dark, false, 100).mean.x, 0);
}

// A matched one is seen through: there even light is sampled too, and the dark counts alone.
TEST(SkyEnd, InTheDarkIsWorthWhatEvenLightAddsWhereItIsSampledToo) {
    const auto dark = make_fixture(make_ball(1), {}),
               lit = make_fixture(make_ball(1), make_white_sky());
    const bake::Moments weights = trace(*dark, true, 20000), light = trace(*lit, false, 20000),
                        part = trace(*lit, true, 20000);
    const double error = std::hypot(standard_error(weights), standard_error(light));
    EXPECT_LT(error, 0.01);
    EXPECT_NEAR(weights.mean.x, light.mean.x, 4 * error);
    EXPECT_LT(part.mean.x, 0.9 * light.mean.x);
}

}  // namespace
}  // namespace opaline::tests
