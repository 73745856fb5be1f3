#include "bake/effects/volumes/place_nodes.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/volumes/node_albedo.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/attenuation.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

using formats::SparseRow;

// V of a node: its row, and its depths toward the coarse cells.
struct Lit {
    SparseRow row;
    std::vector<float> coarse;  // band after band
};

Lit light_node(const VolumeJob& job, const PlacedNodes& nodes, const NodePlace& place,
               std::uint64_t& rays) {
    const std::size_t bands = nodes.space.extinction_bands(), cells = nodes.fine.size();
    std::vector<float> fine(bands * cells);
    rays += gather_attenuation(nodes.space, job.rays, nodes.fine,
                               position_of(job, nodes, place.layout->volume, place.node), fine);
    Lit lit;
    for (std::size_t band = 0; band < bands; ++band) {
        const std::vector<float> own(
            fine.begin() + static_cast<std::ptrdiff_t>(band * cells),
            fine.begin() + static_cast<std::ptrdiff_t>((band + 1) * cells));
        const std::vector<float> reduced = reduce_cells(own, nodes.fine.n, nodes.coarse.n);
        lit.coarse.insert(lit.coarse.end(), reduced.begin(), reduced.end());
    }
    // The rows of a node have as many bands as any of them needs.
    const std::size_t known = fine.size();
    fine.resize(nodes.space.bands() * cells);
    for (std::size_t i = known; i < fine.size(); ++i) {
        fine[i] = fine[i - cells];
    }
    const auto row_bands = static_cast<std::uint32_t>(nodes.space.bands());
    scale_rows(nodes.albedo[place.layout->volume][place.node], row_bands, cells, fine);
    lit.row = std::move(encode_node_rows(nodes.attenuated[number_of(job, *place.layout)], fine, 1,
                                         nodes.fine.n, row_bands)
                            .front());
    return lit;
}

}  // namespace

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

std::vector<Receiver> draw_onlookers(const formats::Scene& scene,
                                     std::span<const VolumeLayout> layouts) {
    constexpr std::size_t kPlaces = 512;
    std::vector<glm::vec3> all;
    for (const VolumeLayout& layout : layouts) {
        if (!layout.sees_surfaces) continue;
        const formats::Volume& volume = scene.volumes[layout.volume];
        for (const glm::ivec3 node : lattice_of(volume, layout).node) {
            all.emplace_back(volume.density.to_scene * glm::dvec4(glm::dvec3(node), 1.0));
        }
    }
    const std::size_t count = std::min(all.size(), kPlaces);
    std::vector<Receiver> onlookers;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 place = all[(2 * i + 1) * all.size() / (2 * count)];
        const glm::vec3 way = even_direction(i, static_cast<std::uint32_t>(count), 0.5f, 0.5f);
        onlookers.push_back({place, way});
        onlookers.push_back({place, -way});
    }
    return onlookers;
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

LitNodes light_nodes(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                     std::uint64_t& rays) {
    LitNodes lit;
    lit.depths = make_depth_table(nodes.count, nodes.coarse.size(), nodes.space.extinction_bands());
    struct Block {
        std::vector<Lit> nodes;
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        nodes.count, kNodesAtOnce, context,
        [&](Range range) {
            Block block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.nodes.push_back(
                    light_node(job, nodes, find_place(job, nodes, i), block.rays));
            }
            return block;
        },
        [&](Range range, Block&& block) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                Lit& own = block.nodes[i - range.begin];
                const std::size_t cells = nodes.coarse.size();
                for (std::size_t band = 0; band < lit.depths.bands; ++band) {
                    set_depths(lit.depths, i, band,
                               std::span(own.coarse).subspan(band * cells, cells));
                }
                lit.row.push_back(std::move(own.row));
            }
            rays += block.rays;
            if (context.on_progress) {
                context.on_progress({"light in volumes", range.end, nodes.count});
            }
        });
    return lit;
}

}  // namespace opaline::bake
