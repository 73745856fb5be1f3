#include "bake/trace/density/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/effects/volumes/volume_walks.h"
#include "tests/bake/scattering/phase_support.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

TEST(Attenuation, LightReachesTheCentreOfABallAlikeFromAllSides) {
    const formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.05), 2, 1, 0));
    const DensitySpace space = make_density_space(scene);
    const LightCells cells = make_light_cells(8);
    std::vector<float> v(cells.size());
    gather_attenuation(space, tests::empty_space(), cells, glm::vec3(0), v);
    for (const float value : v) {
        EXPECT_NEAR(value, std::exp(-2.0), 0.01 * std::exp(-2.0));
    }
}

TEST(Attenuation, DepthsAreKeptToATwoThousandth) {
    DepthTable table = make_depth_table(2, 8, 1);
    const std::vector<float> v{1, 0.5f, 1e-3f, 0, 0.9f, 1e-6f, 0.25f, 1e-30f};
    set_depths(table, 1, 0, v);
    const LightCells cells = make_light_cells(2);
    for (std::size_t i = 0; i < v.size(); ++i) {
        const float depth = static_cast<float>(table.codes(1, 0)[i]) * DepthTable::kStep;
        EXPECT_NEAR(std::exp(-depth), v[i], 5e-4 * static_cast<double>(v[i]) + 2e-7);
    }
}

TEST(Attenuation, LightBetweenNodesHasTheMeanOfTheirDepths) {
    const LightCells cells = make_light_cells(2);
    DepthTable table = make_depth_table(2, cells.size(), 1);
    set_depths(table, 0, 0, std::vector<float>(cells.size(), 0.5f));
    set_depths(table, 1, 0, std::vector<float>(cells.size(), 0.1f));
    const ScaledPhase phase = scale_phase(tests::hg(0.4));
    ScatteredLight light;
    light.depth.fill(table.codes(0, 0));
    light.depth[5] = table.codes(1, 0);
    light.node_weight.fill(0.1f);
    light.node_weight[5] = 0.3f;
    light.direction = {0, 0.6f, 0.8f};
    light.phase = &phase.monomial;
    light.weight = {2, 3, 0};
    std::vector<float> sum(2 * cells.size(), 1.0f);
    add_scattered(light, cells, 2, sum.data());
    const float v = std::pow(0.5f, 0.7f) * std::pow(0.1f, 0.3f);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float value = eval_scaled(phase, glm::dot(light.direction, cells.direction(i))) * v;
        EXPECT_NEAR(sum[i], 1 + 2 * value, 2e-4);
        EXPECT_NEAR(sum[cells.size() + i], 1 + 3 * value, 2e-4);
    }
}

}  // namespace
}  // namespace opaline::bake
