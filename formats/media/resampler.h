#pragma once

#include <algorithm>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "formats/gltf/report.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats {

/// The shortest edge of a voxel, in units of the space that a transform leads to.
inline double shortest_edge(const glm::dmat4& to_space) {
    return std::min({glm::length(glm::dvec3(to_space[0])), glm::length(glm::dvec3(to_space[1])),
                     glm::length(glm::dvec3(to_space[2]))});
}

/// Values of a grid at the voxels of another one of the same file, linear between its own; floats
/// are grey colours. Refers to the grid, which must stay.
struct Resampler {
    const VdbGrid& grid;
    glm::mat4 to_own{1};        ///< index coordinates of the other one to those of the grid
    bool is_same = true;        ///< both have the same voxels
    bool loses_detail = false;  ///< its voxels are finer than the other ones

    /// `other_space`: the transform of the other one in the file.
    Resampler(const VdbGrid& values, const glm::dmat4& other_space) : grid(values) {
        const glm::dmat4& own = grid.is_color ? grid.color.to_scene : grid.scalar.to_scene;
        to_own = glm::mat4(glm::inverse(own) * other_space);
        is_same = own == other_space;
        loses_detail = !is_same && shortest_edge(own) < 0.75 * shortest_edge(other_space);
    }
    /// Whether a brick of the other one's lattice may have values.
    bool may_reach(glm::ivec3 brick) const {
        return !is_same ||
               (grid.is_color ? grid.color.brick_at(brick) : grid.scalar.brick_at(brick)) !=
                   SparseGrid<float>::kEmpty;
    }
    glm::vec3 at(glm::ivec3 voxel) const {
        if (is_same) return grid.is_color ? grid.color.at(voxel) : glm::vec3(grid.scalar.at(voxel));
        const glm::vec3 place(to_own * glm::vec4(glm::vec3(voxel), 1));
        return grid.is_color ? grid.color.sample(place) : glm::vec3(grid.scalar.sample(place));
    }
};

/// A warning of voxels that were set to 0, if any were.
inline void warn_of_repairs(const std::filesystem::path& file, const VdbGrid& grid,
                            std::vector<Diagnostic>& warnings) {
    if (grid.not_a_number + grid.negative > 0) {
        warnings.push_back(
            make_warning(file.string(), "grid " + gltf::in_quotes(grid.name),
                         std::to_string(grid.not_a_number) + " voxels are not a number and " +
                             std::to_string(grid.negative) + " are negative, of " +
                             std::to_string(grid.active_voxels) + ": they count as 0",
                         "export it again if they should not be"));
    }
}

/// A warning of details that are lost where the other grid is that of the density.
inline void warn_of_lost_detail(const std::filesystem::path& file, const Resampler& values,
                                std::vector<Diagnostic>& warnings) {
    if (values.loses_detail) {
        warnings.push_back(
            make_warning(file.string(), "grid " + gltf::in_quotes(values.grid.name),
                         "its voxels are finer than those of the density, at which it is sampled",
                         "write both with the same voxels"));
    }
}

}  // namespace opaline::formats
