#pragma once

#include "bake/effects/volumes/volume_walks.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::tests {

/// One volume with light at its nodes, as walks and paths see it.
struct LitSpace {
    formats::Scene scene;
    bake::RayScene sky = empty_space();
    bake::DensitySpace space;
    std::vector<bake::NodeLattice> lattices;
    std::vector<std::size_t> first{0};
    bake::LightCells cells;
    bake::DepthTable depths;

    LitSpace(formats::Volume volume, std::uint32_t spacing, bake::LightCells given)
        : scene(scene_of(std::move(volume))),
          space(bake::make_density_space(scene)),
          cells(std::move(given)) {
        lattices.push_back(bake::make_node_lattice(scene.volumes.front().density, spacing));
        const auto& node = lattices.front().node;
        depths = bake::make_depth_table(node.size(), cells.size(), space.extinction_bands());
        std::vector<float> light(space.extinction_bands() * cells.size());
        for (std::size_t i = 0; i < node.size(); ++i) {
            bake::gather_attenuation(space, sky, cells, position(i), light);
            for (std::size_t band = 0; band < space.extinction_bands(); ++band) {
                bake::set_depths(depths, i, band,
                                 std::span(light).subspan(band * cells.size(), cells.size()));
            }
        }
    }
    glm::vec3 position(std::size_t node) const {
        return glm::vec3(scene.volumes.front().density.to_scene *
                         glm::dvec4(glm::dvec3(lattices.front().node[node]), 1));
    }
    bake::VolumeWalkSpace walk() const { return {space, sky, lattices, first, depths, cells, 0}; }
};

}  // namespace opaline::tests
