#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/plan/knobs.h"
#include "bake/volumes/volume_walks.h"

namespace opaline::bake {

/// Directions of light that share a path: a path is bent toward the middle of its cells.
struct PathCells {
    struct Group {
        glm::dvec3 middle{0, 0, 1};       ///< unit
        std::vector<std::uint32_t> cell;  ///< numbers of the light's cells
    };
    std::vector<Group> group;
};

/// Squares of 2 x 2 texels of a cube map of light; each cell by itself where n is below 2.
PathCells group_cells(const LightCells& cells);

/// What all quasi-paths share, read-only.
struct VolumePathSpace {
    const VolumeWalkSpace& walk;  ///< densities, nodes and their light; its surfaces stop no path
    const PathCells& groups;      ///< of the light's cells
    /// Moments lambda_0 = 1, lambda_1, ... of the phase function of all volumes, 1 or more, each in
    /// [-1, 1]. Those of the rest without its peak, where densities are without it.
    std::span<const double> lambda;
    /// Scattering depths onward, 1 or more, > 0, at which turns end, in units of that of the ray;
    /// the mean over them counts.
    std::span<const double> lengths;
};

/// Where path integration is wanted.
struct PathReceiver {
    std::uint32_t volume = 0;
    std::size_t node = 0;      ///< of the table: how views are turned depends on it
    glm::vec3 position{0};     ///< [m]
    std::uint32_t views = 32;  ///< directions away from the eye, even; at least 2 K for K rows
    std::uint32_t terms = 1;   ///< K: 1, 4, 9, 16 or 25
};

/// Steps that quasi-paths took. A pure count, the same for any number of threads.
using PathSteps = std::uint64_t;

/// Adds the source radiance toward an eye, of light from each cell that was scattered at least once
/// before [1/sr], by quasi-paths (README.md, "Paths"): math of `path_integral/`, with the light
/// between nodes that walks see. `onward`: unit, away from the eye. `sum`: bands * cells numbers.
PathSteps add_path_light(const VolumePathSpace& space, glm::vec3 position, glm::vec3 onward,
                         std::span<float> sum);

/// T_k toward every cell by quasi-paths: what gather_walks returns by walks, in the same layout.
PathSteps gather_paths(const VolumePathSpace& space, const PathReceiver& receiver,
                       std::span<float> out);

/// Length of a path's steps [m], at most: half the distance between the nodes whose light it sees,
/// not below the shortest edge of a voxel. `spacing`: voxels.
double path_step_length(const formats::SparseGrid<float>& grid, std::uint32_t spacing);

/// VolumePathSpace::lengths: 1 for draft and preview, 1/2, 1 and 2 for production and reference.
std::span<const double> path_lengths(Quality quality);

}  // namespace opaline::bake
