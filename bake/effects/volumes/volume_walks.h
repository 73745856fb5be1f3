#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/exchange/seen_light.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/density/scaled_phase.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Light of all directions that reaches a point between nodes, and is scattered there.
struct ScatteredLight {
    /// Optical depths of the eight nodes around it toward each cell (DepthTable), and their
    /// weights. Depths are interpolated, not light: they are linear where the density is even.
    std::array<const std::uint16_t*, 8> depth{};
    std::array<float, 8> node_weight{};
    glm::vec3 direction{0};  ///< unit, from the eye on: light leaves along its opposite
    const std::array<float, ScaledPhase::kHighestDegree + 1>* phase = nullptr;  ///< p' by power
    std::array<float, 3> weight{};                                              ///< by band
};

/// Adds to `sum`, of `bands` times cells.size() numbers band after band, for each cell l
///     weight p'(direction . l) e^-depth(l).
/// The number of cells is a multiple of 8.
void add_scattered(const ScatteredLight& light, const LightCells& cells, std::size_t bands,
                   float* sum);

/// What all walks share, read-only.
struct VolumeWalkSpace {
    const DensitySpace& space;
    const RayScene& rays;
    std::span<const NodeLattice> lattices;  ///< one a volume
    std::span<const std::size_t> first;     ///< number of each volume's first node in the table
    const DepthTable& depths;               ///< of the nodes of all volumes
    const LightCells& cells;                ///< of the table
    std::uint64_t seed = 0;
    const SeenLight* surfaces = nullptr;  ///< that send light to volumes; null: black
};

/// Where multiple scattering is wanted.
struct WalkReceiver {
    std::uint32_t volume = 0;
    std::size_t node = 0;       ///< of the table: the random numbers depend on it
    glm::vec3 position{0};      ///< [m]
    std::uint32_t walks = 64;   ///< W
    std::uint32_t terms = 1;    ///< K: 1, 4, 9, 16 or 25
    bool sees_sky = true;       ///< light of the sky that was scattered before counts
    bool sees_surfaces = true;  ///< and what surfaces send, where walks have them
};

/// T_k toward every cell (README.md, "Walks"): in-scattered source radiance of light that was
/// scattered at least once before, by the volumes or by surfaces [1/sr]. `out`: terms * bands *
/// cells numbers, term after term and band after band, overwritten; bands as DensitySpace::bands.
/// `odd`: the same of every other walk alone; empty: not wanted. Returns the rays traced.
std::uint64_t gather_walks(const VolumeWalkSpace& walk, const WalkReceiver& receiver,
                           std::span<float> out, std::span<float> odd = {});

}  // namespace opaline::bake
