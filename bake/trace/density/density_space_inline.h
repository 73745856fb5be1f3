#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "bake/trace/density/density_space.h"
#include "bake/trace/density/grid_loops.h"

namespace opaline::bake {

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
