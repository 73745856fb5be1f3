#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/volumes/volume_walks.h"
#include "bake/physics/path_integral/grid_medium.h"
#include "bake/plan/knobs.h"
#include "bake/trace/density/density_space.h"

namespace opaline::bake {

/// All volumes together, as a medium of `physics/path_integral/`. Paths turn by the scattering of
/// the band that scatters most; the coefficients of the other bands at the last queried point are
/// kept.
class VolumeMedium {
  public:
    /// Refers to the space, which must stay.
    explicit VolumeMedium(const DensitySpace& space) : space_(space) {
        std::array<float, 3> most{};
        for (const DensityVolume& volume : space.volumes) {
            for (std::size_t band = 0; band < 3; ++band) {
                most[band] += volume.albedo[band] * volume.sigma_t[band];
            }
        }
        for (std::size_t band = 1; band < 3; ++band) {
            lead_ = most[band] > most[lead_] ? band : lead_;
        }
    }

    /// `x` [m] in the scene.
    Coefficients operator()(glm::dvec3 x) {
        here_ = {};
        for (const DensityVolume& volume : space_.volumes) {
            const auto density = static_cast<double>(volume.density(glm::vec3(x)));
            if (!(density > 0)) continue;
            const std::array<float, 3> albedo = volume.albedo_at(glm::vec3(x));
            for (std::size_t band = 0; band < space_.bands(); ++band) {
                const double extinction = density * static_cast<double>(volume.sigma_t[band]);
                const double scattering = extinction * static_cast<double>(albedo[band]);
                here_[band].scattering += scattering;
                here_[band].absorption += extinction - scattering;
            }
        }
        return here_[space_.bands() == 1 ? 0 : lead_];
    }

    /// Of each band of the space, where it was asked last.
    const std::array<Coefficients, 3>& here() const { return here_; }

  private:
    const DensitySpace& space_;
    std::size_t lead_ = 0;
    std::array<Coefficients, 3> here_{};
};

/// The box around all volumes: nothing is outside of it.
inline VolumeBox box_of(const DensitySpace& space) {
    VolumeBox box;
    for (std::size_t v = 0; v < space.volumes.size(); ++v) {
        const VolumeBox own = grid_box(*space.volumes[v].grid);
        box.low = v == 0 ? own.low : glm::min(box.low, own.low);
        box.high = v == 0 ? own.high : glm::max(box.high, own.high);
    }
    return box;
}

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
/// before [1/sr], by quasi-paths (README.md, "Paths"): math of `physics/path_integral/`, with the
/// light between nodes that walks see. `onward`: unit, away from the eye. `sum`: bands * cells
/// numbers.
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
