#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "bake/trace/density/grid_loops.h"
#include "bake/trace/density/scaled_phase.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Largest optical depth of a voxel; larger ones are clamped. No grid resolves a hundredth of a
/// voxel, and flights would never end.
inline constexpr float kMostDepth = 64;

/// Cells of a grid: the points [8 b, 8 b + 8) of brick b. A cell below a brick has values without a
/// brick of its own: between its last voxels and the brick's first ones.
struct CellGrid {
    glm::mat3 to_index{1};  ///< index = to_index * position + offset
    glm::vec3 offset{0};
    glm::ivec3 first_cell{0}, extent{0};
    std::vector<float> bound;  ///< of the values in each cell, x fastest
};

/// All but the bounds.
template <class T>
void place_cells(const formats::SparseGrid<T>& grid, const glm::dmat4& to_scene, CellGrid& cells) {
    const glm::dmat4 to_index = glm::inverse(to_scene);
    cells.to_index = glm::mat3(to_index);
    cells.offset = glm::vec3(to_index[3]);
    cells.first_cell = grid.first_brick - 1;
    cells.extent = grid.extent + 1;
}

/// A volume for tracing. Coefficients are those without the forward peak.
struct DensityVolume : CellGrid {
    const formats::SparseGrid<float>* grid = nullptr;
    /// Density times albedo where that varies; null: `albedo` holds everywhere.
    const formats::SparseGrid<glm::vec3>* scattering = nullptr;
    std::shared_ptr<const ScaledGrids> scaled;  ///< holds both, where they are not the scene's
    std::vector<bool> even;                     ///< whether it is that everywhere in the cell
    std::array<float, 3> sigma_t;               ///< c' [1/m] where the density is 1, by band
    std::array<float, 3> albedo;                ///< of c', by band; the largest where it varies
    ScaledPhase phase;

    float densest = 0;  ///< kMostDepth of extinction in a voxel: more looks alike

    float density(glm::vec3 position) const {
        return std::min(grid->sample(to_index * position + offset), densest);
    }
    /// Of c', by band; `albedo` where there is no density.
    std::array<float, 3> albedo_at(glm::vec3 position) const {
        if (scattering == nullptr) return albedo;
        const glm::vec3 index = to_index * position + offset;
        const float here = grid->sample(index);
        if (!(here > 0)) return albedo;
        const glm::vec3 own = scattering->sample(index) / here;
        return {std::min(own.x, albedo[0]), std::min(own.y, albedo[1]), std::min(own.z, albedo[2])};
    }
};

/// All volumes of a scene, which must outlive it.
struct DensitySpace {
    std::vector<DensityVolume> volumes;
    bool is_grey = true;     ///< extinctions of all bands coincide
    bool light_grey = true;  ///< albedos too, and light that surfaces send

    std::size_t extinction_bands() const { return is_grey ? 1 : 3; }
    /// Of rows.
    std::size_t bands() const { return is_grey && light_grey ? 1 : 3; }
};
DensitySpace make_density_space(const formats::Scene& scene);

/// Share of a volume's cells with density in which it is even.
double even_share(const DensityVolume& volume);

/// Optical depth [1] of each band from a point along a unit direction over `reach` [m], or to where
/// no volume is: in closed form in cells of even density, elsewhere by the midpoint rule in steps
/// of at most a voxel.
std::array<float, 3> optical_depth(const DensitySpace& space, glm::vec3 from, glm::vec3 direction,
                                   float reach = std::numeric_limits<float>::infinity());

/// Where a flight ends.
struct Collision {
    bool happens = false;
    float distance = 0;        ///< [m]
    std::uint32_t volume = 0;  ///< that scatters
};

/// Calls visit(bound, begin, end) for the cells with density that the ray crosses in [0, reach], in
/// order, distances in metres; ends early where that is false. `Volume`: a CellGrid.
/// With a fourth argument the visitor learns whether the density is `bound` all over the cell.
template <class Volume, class Visit>
void visit_cells(const Volume& volume, glm::vec3 from, glm::vec3 direction, float reach,
                 Visit&& visit);

/// A flight over at most `reach` [m] in one band, unbiased: exact in cells of even density,
/// elsewhere by delta tracking [Woodcock1965]. Collisions with several volumes are independent: the
/// nearest one counts. `random`: float() in [0, 1).
template <class Random>
Collision sample_flight(const DensitySpace& space, std::size_t band, glm::vec3 from,
                        glm::vec3 direction, float reach, Random&& random);

template <class Volume, class Visit>
void visit_cells(const Volume& volume, glm::vec3 from, glm::vec3 direction, float reach,
                 Visit&& visit) {
    constexpr auto kSide = static_cast<float>(formats::SparseGrid<float>::kSide);
    // In units of cells, from the table's lowest corner.
    const glm::vec3 o =
        (volume.to_index * from + volume.offset) / kSide - glm::vec3(volume.first_cell);
    const glm::vec3 d = volume.to_index * direction / kSide;
    const glm::vec3 size(volume.extent);
    float begin = 0, end = reach;
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] != 0) {
            const float a = -o[axis] / d[axis], b = (size[axis] - o[axis]) / d[axis];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        } else if (!(o[axis] >= 0 && o[axis] < size[axis])) {
            return;
        }
    }
    if (!(begin < end)) return;
    glm::ivec3 cell;
    glm::vec3 next, pitch;
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = std::clamp(static_cast<int>(std::floor(o[axis] + begin * d[axis])), 0,
                                volume.extent[axis] - 1);
        const float plane = static_cast<float>(cell[axis] + (d[axis] > 0 ? 1 : 0));
        next[axis] =
            d[axis] != 0 ? (plane - o[axis]) / d[axis] : std::numeric_limits<float>::infinity();
        pitch[axis] = d[axis] != 0 ? 1 / std::abs(d[axis]) : std::numeric_limits<float>::infinity();
    }
    while (true) {
        const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        const float leave = std::min(std::max(next[axis], begin), end);
        const std::size_t number = number_in(volume.extent, cell);
        const float bound = volume.bound[number];
        if (bound > 0 && leave > begin) {
            bool goes_on = true;
            if constexpr (std::is_invocable_v<Visit&, float, float, float, bool>) {
                goes_on = visit(bound, begin, leave, volume.even[number]);
            } else {
                goes_on = visit(bound, begin, leave);
            }
            if (!goes_on) return;
        }
        begin = leave;
        cell[axis] += d[axis] > 0 ? 1 : -1;
        next[axis] += pitch[axis];
        if (begin >= end || cell[axis] < 0 || cell[axis] >= volume.extent[axis]) return;
    }
}

template <class Random>
Collision sample_flight(const DensitySpace& space, std::size_t band, glm::vec3 from,
                        glm::vec3 direction, float reach, Random&& random) {
    Collision nearest;
    nearest.distance = reach;
    for (std::uint32_t v = 0; v < space.volumes.size(); ++v) {
        const DensityVolume& volume = space.volumes[v];
        const float sigma = volume.sigma_t[band];
        if (sigma <= 0) continue;
        // The optical depth to the next possible collision goes on from cell to cell.
        float left = -std::log(1 - random());
        visit_cells(
            volume, from, direction, nearest.distance,
            [&](float bound, float begin, float end, bool is_even) {
                const float majorant = bound * sigma;
                while (true) {
                    const float step = left / majorant;
                    if (begin + step >= end) {
                        left -= (end - begin) * majorant;
                        left = std::max(left, 0.0f);
                        return true;
                    }
                    begin += step;
                    if (is_even || random() * bound < volume.density(from + begin * direction)) {
                        nearest = {true, begin, v};
                        return false;
                    }
                    left = -std::log(1 - random());
                }
            });
    }
    return nearest;
}

}  // namespace opaline::bake
