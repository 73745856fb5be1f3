#include "bake/emitters/surface_elements.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/bake/emitters/lamp_scenes.h"
#include "tests/bake/path_differentials/random_inputs.h"

namespace opaline::bake {
namespace {

// A triangle of area 1/2 in five levels.
formats::Scene half_square() {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.5f);
    return scene;
}

glm::dvec3 random_weights(tests::RandomInputs& random) {
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return {1 - u - v, u, v};
}

TEST(SurfaceElements, LevelsAreThoseOfTheFootprint) {
    const formats::Scene scene = half_square();
    EXPECT_EQ(reflecting_area(scene), 1);
    const ElementLayout layout(scene, 0.5 / 256);
    EXPECT_EQ(layout.size(), 2u * (1 + 4 + 16 + 64 + 256));
    const glm::dvec3 at(0.9, 0.05, 0.05);
    EXPECT_EQ(layout.element({0, 0}, at, 3), 0u);
    EXPECT_EQ(layout.element({0, 0}, at, 0.5), 0u);
    EXPECT_EQ(layout.element({0, 0}, at, 0.49), 1u);
    EXPECT_EQ(layout.element({0, 0}, at, 0.5 / 16), 5u);
    EXPECT_EQ(layout.element({0, 0}, at, 0), layout.finest_element({0, 0}, at));
    EXPECT_GE(layout.finest_element({0, 3}, at), layout.size() / 2);
    EXPECT_EQ(layout.finest_element({0, 0, true}, at), layout.size());  // the back
}

TEST(SurfaceElements, BothSidesOfWhatIsSeenFromBothHaveElements) {
    formats::Scene scene = half_square();
    scene.materials[0].double_sided = true;
    EXPECT_EQ(reflecting_area(scene), 2);
    const ElementLayout layout(scene, 0.1);
    const glm::dvec3 at(0.3, 0.3, 0.4);
    EXPECT_NE(layout.finest_element({0, 0, true}, at), layout.finest_element({0, 0, false}, at));
    EXPECT_LT(layout.finest_element({0, 3, true}, at), layout.size());
}

// Children tile their parent: what a level holds lands, pushed down, around the points it came
// from, and the sum over the finest elements is what was given.
TEST(SurfaceElements, SumIsThePowerReceivedWhateverTheLevels) {
    const formats::Scene scene = half_square();
    const ElementLayout layout(scene, 0.5 / 1024);
    tests::RandomInputs random(50);
    std::vector<glm::dvec3> power(layout.size(), glm::dvec3(0));
    double received = 0;
    for (int i = 0; i < 20000; ++i) {
        const TriangleSide side{0, i % 2 == 0 ? 0u : 3u};
        const double p = random.uniform(0, 1e-3);
        received += p;
        power[layout.element(side, random_weights(random), std::pow(10, random.uniform(-6, 1)))] +=
            glm::dvec3(p, 0, 0);
    }
    const double kept = std::accumulate(
        power.begin(), power.end(), 0.0,
        [](double sum, const glm::dvec3& of_element) { return sum + of_element.x; });
    EXPECT_NEAR(kept, received, 1e-12 * received);
    const std::vector<glm::vec3> irradiance = layout.push_down(power);
    double pushed = 0;
    const std::size_t half = layout.size() / 2, finest = 1024;
    for (const std::size_t end : {half, layout.size()}) {
        for (std::size_t i = end - finest; i < end; ++i) {
            pushed += double{irradiance[i].x} * 0.5 / 1024;
        }
    }
    EXPECT_NEAR(pushed, received, 1e-6 * received);  // floats
}

TEST(SurfaceElements, PushedDownPowerIsSpreadOverItsElementAlone) {
    const formats::Scene scene = half_square();
    const ElementLayout layout(scene, 0.5 / 64);
    std::vector<glm::dvec3> power(layout.size(), glm::dvec3(0));
    const glm::dvec3 at(0.2, 0.7, 0.1);
    power[layout.element({0, 0}, at, 0.13)] += glm::dvec3(3, 0, 0);
    const std::vector<glm::vec3> irradiance = layout.push_down(power);
    tests::RandomInputs random(51);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 weights = random_weights(random);
        const float expected = weights.y > 0.5 ? 3 / 0.125f : 0.0f;
        EXPECT_EQ(irradiance[layout.finest_element({0, 0}, weights)].x, expected);
    }
}

TEST(SurfaceElements, TrianglesWithoutAreaTakeNothing) {
    formats::Scene scene = half_square();
    for (glm::vec3& position : scene.primitives[0].position)
        position.y = 0;
    const ElementLayout layout(scene, 0.1);
    const std::vector<glm::dvec3> power(layout.size(), glm::dvec3(1));
    for (const glm::vec3& irradiance : layout.push_down(power)) {
        EXPECT_EQ(irradiance, glm::vec3(0));
    }
}

}  // namespace
}  // namespace opaline::bake
