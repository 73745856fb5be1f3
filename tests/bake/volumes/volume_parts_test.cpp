#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/effects/volumes/coarse_volume.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_parts.h"
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

// int value dV [m^3] and int value x dV of a grid.
template <class T>
struct Moments {
    glm::dvec3 sum{0}, x{0};
};

template <class T>
Moments<T> moments_of(const formats::SparseGrid<T>& grid, const glm::dmat4& to_scene) {
    Moments<T> moments;
    const double volume = std::abs(glm::determinant(glm::dmat3(to_scene)));
    formats::for_bricks(grid.first_brick, grid.extent, [&](glm::ivec3 brick) {
        const std::uint32_t number = grid.brick_at(brick);
        if (number == formats::SparseGrid<T>::kEmpty) return;
        for (int i = 0; i < 512; ++i) {
            const glm::dvec3 value = volume * glm::dvec3(glm::vec3(grid.brick(number)[i]));
            const glm::dvec3 at(to_scene * glm::dvec4(glm::dvec3(formats::voxel_of(brick, i)), 1));
            moments.sum += value;
            moments.x += value.x * at;
        }
    });
    return moments;
}

template <class T>
void expect_same(const formats::SparseGrid<T>& a, const glm::dmat4& a_to_scene,
                 const formats::SparseGrid<T>& b, const glm::dmat4& b_to_scene, double apart) {
    const Moments<T> x = moments_of(a, a_to_scene), y = moments_of(b, b_to_scene);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(y.sum[k], x.sum[k], 1e-5 * std::abs(x.sum[k]));
        EXPECT_NEAR(y.x[k], x.x[k], apart * x.sum.x);
    }
}

// In a sheared frame, over bricks on both sides of index 0.
formats::Volume make_dappled() {
    std::mt19937 random(5);
    formats::Volume volume = tests::make_volume(
        tests::sample_grid(
            glm::dvec3(1.7, 1.1, 2.3), 0.1,
            [&](glm::dvec3 p) { return p.x + p.y > 0.3 ? 0.0 : 1e-3 * (random() % 1000); }),
        4, 1, 0);
    volume.density.to_scene[1].x = 0.03;
    volume.density.to_scene[3] = glm::dvec4(0.2, -0.7, 3, 1);
    tests::vary_albedo(volume,
                       [](glm::dvec3 p) { return glm::vec3(0.9f, p.z > 0 ? 0.2f : 0.5f, 0.1f); });
    tests::make_it_glow(volume, {3, 2, 1});
    return volume;
}

TEST(JoinVoxels, ExtinctionScatteringAndPowerStayWhereTheyWere) {
    const formats::Volume fine = make_dappled();
    for (const int joined : {1, 2, 4, 8}) {
        SCOPED_TRACE(joined);
        const formats::Volume coarse = join_voxels(fine, joined);
        EXPECT_NEAR(std::cbrt(glm::determinant(glm::dmat3(coarse.density.to_scene)) /
                              glm::determinant(glm::dmat3(fine.density.to_scene))),
                    joined, 1e-9);
        // Voxels of one that is joined differ; a lattice that is off by half a voxel is .05 m away.
        const double apart = 0.004 * (joined - 1) + 1e-5;
        expect_same(fine.density, fine.density.to_scene, coarse.density, coarse.density.to_scene,
                    apart);
        expect_same(fine.scattering, fine.density.to_scene, coarse.scattering,
                    coarse.density.to_scene, apart);
        expect_same(fine.emission, fine.density.to_scene, coarse.emission, coarse.density.to_scene,
                    apart);
        EXPECT_EQ(coarse.scattering.value.size(), coarse.density.value.size());
    }
}

// 14 voxels of 1.5 mean free paths in its radius: 11,500 of them.
formats::Scene dense_ball() {
    return tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 1.0 / 14), 21, 0.9f, 0));
}

TEST(JoinVoxels, NodesAreAsFewAsAQualityBakesUnlessTheirDistanceIsGiven) {
    const formats::Scene scene = dense_ball();
    const auto nodes = [&](const Knobs& knobs) {
        const VolumeParts parts = part_volumes(scene, plan_volumes(scene, knobs).layouts, knobs);
        std::size_t count = 0;
        for (const VolumeLayout& layout : parts.layouts) {
            const formats::Volume& own = parts.scene_or(scene).volumes[layout.volume];
            count += make_node_lattice(own.density, layout.spacing).node.size();
        }
        return count;
    };
    Knobs knobs = tests::knobs_for(Quality::draft);
    EXPECT_LE(nodes(knobs), most_nodes(Quality::draft));
    EXPECT_GT(nodes(knobs), most_nodes(Quality::draft) / 16);
    knobs.set(kVolumeSpacing, 1);
    EXPECT_GT(nodes(knobs), most_nodes(Quality::draft));
    EXPECT_GT(nodes(tests::knobs_for(Quality::production)), most_nodes(Quality::draft));
}

}  // namespace

}  // namespace opaline::bake
