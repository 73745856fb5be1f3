#include "bake/volumes/volume_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scattering/phase_series.h"
#include "tests/bake/path_integral/path_support.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

// One volume with light at its nodes, as walks and paths see it.
struct LitSpace {
    formats::Scene scene;
    RayScene sky = tests::empty_space();
    DensitySpace space;
    std::vector<NodeLattice> lattices;
    std::vector<std::size_t> first{0};
    LightCells cells;
    DepthTable depths;

    LitSpace(formats::Volume volume, std::uint32_t spacing, LightCells given)
        : scene(tests::scene_of(std::move(volume))),
          space(make_density_space(scene)),
          cells(std::move(given)) {
        lattices.push_back(make_node_lattice(scene.volumes.front().density, spacing));
        const auto& node = lattices.front().node;
        depths = make_depth_table(node.size(), cells.size(), space.extinction_bands());
        std::vector<float> light(space.extinction_bands() * cells.size());
        for (std::size_t i = 0; i < node.size(); ++i) {
            gather_attenuation(space, sky, cells, position(i), light);
            for (std::size_t band = 0; band < space.extinction_bands(); ++band) {
                set_depths(depths, i, band,
                           std::span(light).subspan(band * cells.size(), cells.size()));
            }
        }
    }
    glm::vec3 position(std::size_t node) const {
        return glm::vec3(scene.volumes.front().density.to_scene *
                         glm::dvec4(glm::dvec3(lattices.front().node[node]), 1));
    }
    VolumeWalkSpace walk() const { return {space, sky, lattices, first, depths, cells, 0}; }
};

LightCells one_direction(glm::dvec3 l) {
    LightCells cells;
    cells.n = 1;
    cells.x = {static_cast<float>(l.x)};
    cells.y = {static_cast<float>(l.y)};
    cells.z = {static_cast<float>(l.z)};
    return cells;
}

std::vector<double> moments_of(double g, unsigned degrees) {
    return expand_henyey_greenstein(g, degrees).lambda;
}

// The density of a row, sampled at the voxels of a grid.
formats::Volume volume_of(const tests::VolumeRow& row) {
    const double size = row.number("size");
    const bool is_ball = row.cell.at("geometry") == "sphere";
    return tests::make_volume(
        is_ball ? tests::make_ball_grid(size, size / 32) : tests::make_blob(size, size / 12),
        static_cast<float>(row.number("sigma_t")), static_cast<float>(row.number("albedo")), 0);
}

TEST(VolumePaths, SourceRadianceOnAGridIsThatOfTheTable) {
    OPALINE_VOLUME_ROWS(rows, "pi_J2plus");
    for (const auto& row : rows) {
        const LitSpace lit(volume_of(row), 2, one_direction(tests::vector_of(row, "l")));
        const VolumeWalkSpace walk = lit.walk();
        const PathCells groups = group_cells(lit.cells);
        const std::vector<double> lambda = moments_of(row.number("g"), 160);
        const double lengths[] = {row.number("arg")};
        std::vector<float> sum(1);
        EXPECT_GT(
            add_path_light({walk, groups, lambda, lengths}, glm::vec3(tests::vector_of(row, "p")),
                           glm::vec3(tests::vector_of(row, "v")), sum),
            10u);
        EXPECT_NEAR(static_cast<double>(sum[0]) / row.value(), 1, 0.005) << row.id();
    }
}

}  // namespace
}  // namespace opaline::bake
