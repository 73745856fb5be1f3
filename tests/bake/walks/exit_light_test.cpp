#include "bake/effects/multiple/walks/exit_light.h"

#include <gtest/gtest.h>

#include <vector>

namespace opaline::bake {
namespace {

SurfaceSample make_sample(glm::vec3 position, glm::vec3 normal) {
    SurfaceSample sample{};
    sample.position = position;
    sample.normal = sample.geometric_normal = normal;
    sample.area = 1;
    return sample;
}

// Two sides of a sheet thinner than the spacing of its samples.
TEST(ExitLight, FindsTheNearestSampleThatFacesAsTheExitDoes) {
    const std::vector<SurfaceSample> samples{
        make_sample({0, 0, 0}, {0, 1, 0}), make_sample({0.4f, -0.1f, 0}, {0, -1, 0}),
        make_sample({1, 0, 0}, {0, 1, 0}), make_sample({50, 0, 0}, {0, 1, 0})};
    const SparseVectors none;
    const ExitLight light(samples, none, std::nullopt, 0.9);
    std::vector<std::uint32_t> around;
    const auto nearest = [&](glm::vec3 position, glm::vec3 normal) {
        WalkExit exit;
        exit.position = position;
        exit.normal = normal;
        return light.nearest(exit, around);
    };
    EXPECT_EQ(nearest({0.4f, -0.01f, 0}, {0, 1, 0}), 0u);
    EXPECT_EQ(nearest({0.4f, -0.01f, 0}, {0, -1, 0}), 1u);
    EXPECT_EQ(nearest({0.9f, 0, 0}, {0, 1, 0}), 2u);
    EXPECT_EQ(nearest({300, 0, 0}, {0, 1, 0}), 3u) << "far from all";
    EXPECT_EQ(nearest({1, 0, 0}, {1, 0, 0}), 2u) << "none faces that way";
}

}  // namespace
}  // namespace opaline::bake
