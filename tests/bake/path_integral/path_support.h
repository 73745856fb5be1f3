#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "bake/physics/path_integral/grid_medium.h"
#include "bake/physics/path_integral/turn.h"
#include "formats/sparse_grid.h"
#include "tests/support/volume_table.h"

namespace opaline::tests {

inline bake::VolumeBox cube(double half) {
    return {glm::dvec3(-half), glm::dvec3(half)};
}

/// End of the arc minus its start [m] in a homogeneous medium, where the path turns at a constant
/// rate: (ell_total / b) (sin(angle) / angle from + (1 - cos(angle)) / angle aside), [Premoze2003]
/// (8) with (9). `ell_total` >= 0; `scattering` b [1/m], > 0.
inline glm::dvec3 arc_end(const bake::Turn& turn, double ell_total, double scattering) {
    // 1 - cos(angle) = 2 sin(angle / 2)^2 does not cancel.
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(x) / x; };
    const double lateral = std::sin(turn.angle / 2) * sinc(turn.angle / 2);
    return ell_total / scattering * (sinc(turn.angle) * turn.from + lateral * turn.aside);
}

inline glm::dvec3 vector_of(const VolumeRow& row, const std::string& name) {
    return {row.number(name + "x"), row.number(name + "y"), row.number(name + "z")};
}

/// sigma exp(-|x|^2 / (2 size^2)) around the origin, 0 beyond |x| = cut.
struct Blob {
    double sigma_t = 1, size = 1, albedo = 1;
    double cut = std::numeric_limits<double>::infinity();

    double extinction(glm::dvec3 x) const {
        const double squared = glm::dot(x, x);
        return squared > cut * cut ? 0 : sigma_t * std::exp(-squared / (2 * size * size));
    }
    bake::Coefficients operator()(glm::dvec3 x) const {
        const double c = extinction(x);
        return {albedo * c, (1 - albedo) * c};
    }
    /// e^-depth of the half line from x along l.
    double visibility(glm::dvec3 x, glm::dvec3 l) const {
        const double from = glm::dot(x, l), squared = glm::dot(x, x) - from * from;
        const double to = std::sqrt(std::max(cut * cut - squared, 0.0));
        const double scale = 1 / (std::numbers::sqrt2 * size);
        const double depth = sigma_t * size * std::sqrt(std::numbers::pi / 2) *
                             std::exp(-squared * scale * scale) *
                             (std::erf(to * scale) - std::erf(from * scale));
        return std::exp(-std::max(depth, 0.0));
    }
};

/// Homogeneous within |x| <= radius.
struct Ball {
    double sigma_t = 1, radius = 1, albedo = 1;

    bake::Coefficients operator()(glm::dvec3 x) const {
        const double c = glm::dot(x, x) > radius * radius ? 0 : sigma_t;
        return {albedo * c, (1 - albedo) * c};
    }
    double visibility(glm::dvec3 x, glm::dvec3 l) const {
        const double along = glm::dot(x, l);
        const double root = along * along + radius * radius - glm::dot(x, x);
        return std::exp(-sigma_t * std::max(std::sqrt(std::max(root, 0.0)) - along, 0.0));
    }
};

/// Samples a density at the voxels of all bricks with coordinates in [first, first + extent).
template <class Density>
formats::SparseGrid<float> sample_grid(const Density& density, glm::ivec3 first, glm::ivec3 extent,
                                       const glm::dmat4& to_scene) {
    using Grid = formats::SparseGrid<float>;
    Grid grid;
    grid.first_brick = first;
    grid.extent = extent;
    grid.to_scene = to_scene;
    for (int z = 0; z < extent.z; ++z) {
        for (int y = 0; y < extent.y; ++y) {
            for (int x = 0; x < extent.x; ++x) {
                grid.table.push_back(static_cast<std::uint32_t>(grid.table.size()));
                for (int v = 0; v < static_cast<int>(Grid::kBrickVoxels); ++v) {
                    const glm::ivec3 voxel =
                        Grid::kSide * (first + glm::ivec3(x, y, z)) +
                        glm::ivec3(v % Grid::kSide, v / Grid::kSide % Grid::kSide,
                                   v / (Grid::kSide * Grid::kSide));
                    const glm::dvec3 at(to_scene * glm::dvec4(glm::dvec3(voxel), 1));
                    grid.value.push_back(static_cast<float>(density(at)));
                }
            }
        }
    }
    return grid;
}

}  // namespace opaline::tests
