#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "bake/path_differentials/differential_column.h"

namespace opaline::bake {

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
