#include "bake/effects/volumes/volume_parts.h"

#include <gtest/gtest.h>

#include <random>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

// Smoke below a dense core: a plume 3 m wide, and a ball of .7 m that has a hundred times as much.
formats::Volume make_smoke() {
    return tests::make_volume(tests::sample_grid(glm::dvec3(3.2), 0.1,
                                                 [](glm::dvec3 p) {
                                                     const double r = glm::length(p);
                                                     return r > 3 ? 0.0 : r < 0.7 ? 1.0 : 0.01;
                                                 }),
                              10, 0.9f, 0);
}

Knobs parting_knobs() {
    return tests::knobs_for(Quality::preview);
}

VolumeParts part(const formats::Scene& scene, const Knobs& knobs = parting_knobs()) {
    return part_volumes(scene, plan_volumes(scene, knobs).layouts, knobs);
}

TEST(VolumeParts, DenseBricksHaveNodesCloserTogetherAndFewerNodesInAll) {
    const formats::Scene scene = tests::scene_of(make_smoke());
    const VolumeParts parts = part(scene);
    ASSERT_TRUE(parts.scene);
    ASSERT_EQ(parts.scene->volumes.size(), 2u);
    ASSERT_EQ(parts.layouts.size(), 2u);
    EXPECT_EQ(parts.layouts[0].spacing, 1u);
    EXPECT_EQ(parts.layouts[1].spacing, 8u);
    std::size_t nodes = 0;
    for (const VolumeLayout& layout : parts.layouts) {
        EXPECT_EQ(layout.whole, 0u);
        const formats::Volume& own = parts.scene->volumes.at(layout.volume);
        EXPECT_EQ(own.name, "volume");
        EXPECT_EQ(own.albedo, scene.volumes[0].albedo);
        nodes += make_node_lattice(own.density, layout.spacing).node.size();
    }
    EXPECT_LT(nodes, make_node_lattice(scene.volumes[0].density, 1).node.size() / 4);
}

TEST(VolumeParts, DensitiesAddUpToThoseOfTheWholeAlsoBetweenBricks) {
    const formats::Scene scene = tests::scene_of(make_smoke());
    const VolumeParts parts = part(scene);
    ASSERT_TRUE(parts.scene);
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(-35, 35);
    int both = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 at(uniform(engine), uniform(engine), uniform(engine));
        const float first = parts.scene->volumes[0].density.sample(at);
        const float second = parts.scene->volumes[1].density.sample(at);
        both += first > 0 && second > 0 ? 1 : 0;
        EXPECT_NEAR(first + second, scene.volumes[0].density.sample(at), 1e-6f);
    }
    EXPECT_GT(both, 20);
}

TEST(VolumeParts, OfAVolumeThatIsAsDenseEverywhereThereAreNone) {
    EXPECT_FALSE(
        part(tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.1), 5, 0.9f, 0))).scene);
}

TEST(VolumeParts, AreNotMadeWhereOneDistanceIsAskedFor) {
    Knobs knobs = parting_knobs();
    knobs.set(kVolumeSpacing, 4);
    const VolumeParts parts = part(tests::scene_of(make_smoke()), knobs);
    EXPECT_FALSE(parts.scene);
    EXPECT_EQ(parts.layouts.at(0).spacing, 4u);
}

TEST(VolumeParts, VolumesThatGlowOrWhoseAlbedoVariesStayWhole) {
    formats::Volume coloured = make_smoke();
    tests::vary_albedo(coloured, [](glm::dvec3 p) { return glm::vec3(p.y > 0 ? 0.9f : 0.5f); });
    EXPECT_EQ(part(tests::scene_of(coloured)).layouts.size(), 1u);
    formats::Volume glowing = make_smoke();
    const auto& density = glowing.density;
    glowing.emission = {density.first_brick, density.extent, density.table,
                        std::vector<glm::vec3>(density.value.size(), glm::vec3(1)),
                        density.to_scene};
    EXPECT_EQ(part(tests::scene_of(glowing)).layouts.size(), 1u);
}

TEST(VolumeParts, OtherVolumesKeepTheirLayouts) {
    formats::Scene scene = tests::scene_of(
        tests::make_volume(tests::make_ball_grid(1, 0.1), 5, 0, 0));  // absorbs alone
    scene.volumes.push_back(make_smoke());
    scene.volumes.push_back(tests::make_volume(tests::make_ball_grid(1, 0.1), 5, 0.9f, 0));
    const VolumeParts parts = part(scene);
    ASSERT_TRUE(parts.scene);
    ASSERT_EQ(parts.scene->volumes.size(), 4u);
    std::vector<std::uint32_t> whole;
    for (const VolumeLayout& layout : parts.layouts) {
        whole.push_back(layout.whole);
    }
    EXPECT_EQ(whole, (std::vector<std::uint32_t>{0, 1, 1, 2}));
    EXPECT_FALSE(parts.layouts[0].has_nodes());
    EXPECT_EQ(parts.scene->volumes[parts.layouts[3].volume].density.value,
              scene.volumes[2].density.value);
}

TEST(VolumeParts, AreNoMoreThanOpenGlDraws) {
    formats::Scene scene = tests::scene_of(make_smoke());
    for (const std::size_t most : {2u, 4u, 4u, 4u, 5u}) {
        const VolumeParts parts = part(scene);
        EXPECT_EQ(parts.layouts.size(), most) << scene.volumes.size();
        EXPECT_EQ(parts.scene_or(scene).volumes.size(), most);
        scene.volumes.push_back(make_smoke());
    }
}

}  // namespace
}  // namespace opaline::bake
