#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/node_rows.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_walks.h"
#include "bake/exchange/bounce_light.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/sparse_rows.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Nodes that a thread takes at once.
inline constexpr std::size_t kNodesAtOnce = 16;

/// What volumes are baked from.
struct VolumeJob {
    const formats::Scene& scene;
    const RayScene& rays;  ///< surfaces that block the light; may be empty
    std::span<const VolumeLayout> layouts;
    const Knobs& knobs;
    const BounceLight* surfaces = nullptr;  ///< that send light to volumes; null: black
};

/// The volumes of a scene, with the rows of layouts.
DensitySpace make_density_space(const formats::Scene& scene, std::span<const VolumeLayout> layouts);

/// Edges of the cube maps of single scattering, and of multiple scattering, which is smoother:
/// light changes little within 5 degrees, light that is scattered often within 11.
std::uint32_t fine_cells(const Knobs& knobs);
std::uint32_t coarse_cells(const Knobs& knobs);

/// Where the light of a volume is baked.
NodeLattice lattice_of(const formats::Volume& volume, const VolumeLayout& layout);

/// All that is known before light is followed.
struct PlacedNodes {
    DensitySpace space;
    /// Of each volume of the scene; empty where nothing is baked.
    std::vector<NodeLattice> lattices;
    std::vector<std::size_t> first;              ///< node of each volume, among all
    std::vector<std::vector<glm::vec3>> albedo;  ///< shares of each volume's nodes
    std::vector<std::vector<float>> density;     ///< around each volume's nodes
    std::size_t count = 0;
    LightCells fine, coarse;                         ///< fine_cells, coarse_cells
    std::vector<NodeEncoder> attenuated, scattered;  ///< of row V and of all T_k, one a layout
};

/// Errors: none; where a layout has no nodes, its lattice is empty.
PlacedNodes place_nodes(const VolumeJob& job);

/// Places in volumes that see surfaces, evenly among their nodes, each looking two ways: for
/// LightInputs::onlookers.
std::vector<Receiver> draw_onlookers(const formats::Scene& scene,
                                     std::span<const VolumeLayout> layouts);

/// [m], of a volume's node.
glm::vec3 position_of(const VolumeJob& job, const PlacedNodes& nodes, std::uint32_t volume,
                      std::size_t node);

/// The layout that a node among all belongs to, and its number there.
struct NodePlace {
    const VolumeLayout* layout = nullptr;
    std::size_t node = 0;
};

NodePlace find_place(const VolumeJob& job, const PlacedNodes& nodes, std::size_t number);

/// Of a layout, among the job's.
std::size_t number_of(const VolumeJob& job, const VolumeLayout& layout);

/// Rows of a node times its albedo's share, term after term and band after band.
void scale_rows(glm::vec3 share, std::size_t bands, std::size_t cells, std::span<float> rows);

/// The attenuated light of all nodes, as rows and for walks.
struct LitNodes {
    std::vector<formats::SparseRow> row;
    DepthTable depths;
};

/// Follows it from the sky to each node: rows V, not yet shared out, and depths toward the coarse
/// cells. Counts `rays`. The same bits for any number of threads; incomplete if the context is
/// cancelled.
LitNodes light_nodes(const VolumeJob& job, const PlacedNodes& nodes, const Context& context,
                     std::uint64_t& rays);

}  // namespace opaline::bake
