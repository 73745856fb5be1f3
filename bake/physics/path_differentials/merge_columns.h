#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace opaline::bake {

/// How the current vertex of a path moves with one of its random numbers x_j in [0, 1], or with a
/// sum of them that was merged.
struct DifferentialColumn {
    glm::dvec3 dP{0};  ///< of the vertex [m]
    glm::dvec3 dD{0};  ///< of the unit direction of propagation
    double dlnW = 0;   ///< relative change of the contribution
    double step = 1;   ///< full length that x_j moves by, in units of the path's step
};

/// Where columns are merged: at a vertex of direction D, whose points move in the plane with normal
/// N_g, or in space in a volume.
struct MergeSpace {
    glm::dvec3 D{0, 0, 1};
    std::optional<glm::dvec3> N_g;
};

/// Replaces columns, times the steps given, by the fewest with the same second moments of (dP, dD,
/// dlnW): at most 5, 6 in a volume. Transfer and specular events are linear, so every later rms
/// footprint stays the same. `steps`: the full step of each column; that of a merged one is 1.
/// Returns how many columns there are now, in front.
std::size_t merge_columns(std::span<DifferentialColumn> columns, std::span<const double> steps,
                          const MergeSpace& space);

}  // namespace opaline::bake
