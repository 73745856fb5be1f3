#include "bake/volumes/place_nodes.h"

#include <algorithm>
#include <array>

#include "bake/volumes/node_albedo.h"
#include "bake/volumes/node_worth.h"
#include "bake/volumes/volume_knobs.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {

DensitySpace make_density_space(const formats::Scene& scene,
                                std::span<const VolumeLayout> layouts) {
    DensitySpace space = make_density_space(scene);
    space.light_grey = space.light_grey && std::ranges::none_of(layouts, &VolumeLayout::coloured);
    return space;
}

std::uint32_t fine_cells(const Knobs& knobs) {
    return std::min(knobs.cubemap_size, knobs.quality == Quality::reference ? 32u : 16u);
}

std::uint32_t coarse_cells(const Knobs& knobs) {
    return std::min(knobs.cubemap_size, knobs.quality == Quality::reference ? 16u : 8u);
}

NodeLattice lattice_of(const formats::Volume& volume, const VolumeLayout& layout) {
    return layout.glows ? make_node_lattice(volume.density, layout.spacing, volume.emission)
                        : make_node_lattice(volume.density, layout.spacing);
}

PlacedNodes place_nodes(const VolumeJob& job) {
    PlacedNodes nodes;
    nodes.space = make_density_space(job.scene, job.layouts);
    nodes.lattices.resize(job.scene.volumes.size());
    nodes.first.resize(job.scene.volumes.size());
    // Walks collide in all volumes; one without nodes reflects nothing.
    for (const VolumeLayout& layout : job.layouts) {
        NodeLattice& lattice = nodes.lattices[layout.volume];
        lattice = lattice_of(job.scene.volumes[layout.volume], layout);
        if (!layout.has_nodes()) {
            lattice.node.clear();
            std::ranges::fill(lattice.corner, formats::kNoNode);
        }
    }
    for (std::size_t v = 0; v < nodes.lattices.size(); ++v) {
        nodes.first[v] = nodes.count;
        nodes.count += nodes.lattices[v].node.size();
        nodes.albedo.push_back(node_albedo_shares(nodes.space.volumes[v], nodes.lattices[v]));
        nodes.density.push_back(node_densities(job.scene.volumes[v].density, nodes.lattices[v]));
    }
    nodes.fine = make_light_cells(fine_cells(job.knobs));
    nodes.coarse = make_light_cells(coarse_cells(job.knobs));
    const std::uint32_t n = job.knobs.cubemap_size;
    constexpr std::array<double, 4> kTolerance{0.03, 0.015, 0.005, 0.0};
    for (const VolumeLayout& layout : job.layouts) {
        const NodeCoefficients most = node_coefficients(job.knobs, layout.often_terms);
        const double tolerance = kTolerance[static_cast<std::size_t>(job.knobs.quality)];
        const std::uint32_t more = node_candidates(job.knobs.quality);
        nodes.attenuated.push_back({make_selector(n, more * most.attenuated), tolerance});
        nodes.scattered.push_back({make_selector(n, more * most.scattered), tolerance});
    }
    return nodes;
}

glm::vec3 position_of(const VolumeJob& job, const PlacedNodes& nodes, std::uint32_t volume,
                      std::size_t node) {
    return glm::vec3(job.scene.volumes[volume].density.to_scene *
                     glm::dvec4(glm::dvec3(nodes.lattices[volume].node[node]), 1.0));
}

NodePlace find_place(const VolumeJob& job, const PlacedNodes& nodes, std::size_t number) {
    for (const VolumeLayout& layout : job.layouts) {
        const std::size_t first = nodes.first[layout.volume];
        if (number >= first && number - first < nodes.lattices[layout.volume].node.size()) {
            return {&layout, number - first};
        }
    }
    return {};
}

std::size_t number_of(const VolumeJob& job, const VolumeLayout& layout) {
    return static_cast<std::size_t>(&layout - job.layouts.data());
}

void scale_rows(glm::vec3 share, std::size_t bands, std::size_t cells, std::span<float> rows) {
    if (share == glm::vec3(1)) return;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] *= share[static_cast<int>(i / cells % bands)];
    }
}

}  // namespace opaline::bake
