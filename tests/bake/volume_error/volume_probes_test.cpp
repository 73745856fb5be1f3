#include "bake/check/volumes/volume_probes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/bake/volumes/volume_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCount = 400;

formats::Scene blob_scene() {
    return tests::scene_of(tests::make_volume(tests::make_blob(0.5, 0.125), 4, 0.9f, 0));
}

std::vector<VolumeProbe> probes_of(const formats::Scene& scene) {
    const auto reference = make_reference_scene(scene, 1);
    return choose_volume_probes(*reference, kCount, 1);
}

TEST(VolumeProbes, RaysSeeTheSunFromAheadBesideAndBehind) {
    const std::vector<VolumeProbe> probes = probes_of(blob_scene());
    ASSERT_EQ(probes.size(), kCount);
    constexpr std::array<std::array<float, 2>, 3> kCosines{{{0.5f, 1}, {-0.5f, 0.5f}, {-1, -0.5f}}};
    for (const VolumeProbe& probe : probes) {
        EXPECT_NEAR(glm::length(probe.sun), 1, 1e-5f);
        for (std::size_t place = 0; place < kCosines.size(); ++place) {
            const float cosine = glm::dot(probe.sun, probe.ray[place].direction);
            EXPECT_GE(cosine, kCosines[place][0] - 1e-4f);
            EXPECT_LE(cosine, kCosines[place][1] + 1e-4f);
        }
    }
}

TEST(VolumeProbes, RaysComeFromOutsideAndMeetMuchOfTheDensity) {
    const formats::Scene scene = blob_scene();
    const formats::SparseGrid<float>& grid = scene.volumes[0].density;
    const glm::mat4 to_index(glm::inverse(grid.to_scene));
    double column = 0, count = 0;
    for (const VolumeProbe& probe : probes_of(scene)) {
        for (const VolumeRay& ray : probe.ray) {
            EXPECT_EQ(grid.sample(glm::vec3(to_index * glm::vec4(ray.origin, 1))), 0);
            EXPECT_EQ(ray.end, std::numeric_limits<float>::infinity());
            for (float t = 0; t < 16; t += 0.02f) {
                column += 0.02 * static_cast<double>(grid.sample(glm::vec3(
                                     to_index * glm::vec4(ray.origin + t * ray.direction, 1))));
            }
            ++count;
        }
    }
    // Of points drawn in proportion to exp(-r^2 / 2 s^2), the mean of the distance from the line to
    // the middle has two of three axes: the mean column is that of the middle, sqrt(2 pi) s, times
    // 1 / 2.
    EXPECT_NEAR(column / count, 0.5 * std::sqrt(2 * 3.14159) * 0.5, 0.04);
}

TEST(VolumeProbes, SurfacesEndRaysAndHideWhatIsBeforeThem) {
    formats::Scene scene = blob_scene();
    // A wall through the middle, seen from both sides.
    tests::Primitive wall = tests::make_quad({-90, 0, -90}, {0, 0, 180}, {180, 0, 0}, 1);
    scene.primitives.push_back(wall);
    scene.materials[0].double_sided = true;
    double ending = 0;
    for (const VolumeProbe& probe : probes_of(scene)) {
        for (const VolumeRay& ray : probe.ray) {
            const float slope = ray.direction.y;
            ending += ray.end < 1e9f ? 1 : 0;
            if (ray.end < 1e9f) {
                EXPECT_NEAR(ray.origin.y + ray.end * slope, 0, 1e-2f);
            } else {
                // It begins on the wall, or leaves it behind.
                EXPECT_GT(ray.origin.y * slope, -1e-2f);
            }
        }
    }
    // Every line meets the wall once: behind the point that it was drawn through, or before it.
    EXPECT_NEAR(ending / (kLightPlaces * kCount), 0.5, 0.1);
}

TEST(VolumeProbes, NothingIsChosenWhereNoDensityIs) {
    formats::Scene scene;
    scene.materials.resize(1);
    EXPECT_TRUE(probes_of(scene).empty());
}

}  // namespace
}  // namespace opaline::bake
