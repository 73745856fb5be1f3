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

/// What is reached while random numbers move within their steps: the Minkowski sum of segments
/// [-v_j / 2, v_j / 2], v_j = step_j dP_j, in coordinates of the tangent plane. Any number of
/// vectors, in any order and of any sign, zero ones too.

/// Sum over pairs of |v_i x v_j| [m^2]: the exact area.
double polygon_area(std::span<const glm::dvec2> vectors);

/// Two vectors that stand for the footprint.
struct FootprintPair {
    glm::dvec2 A{0}, B{0};
};

/// |A x B|.
double pair_area(const FootprintPair& pair);

/// The largest parallelogram of two groups of vectors adjacent in angle: at least 2 / pi of the
/// area, independent of axes, order and signs.
FootprintPair best_pair(std::span<const glm::dvec2> vectors);

/// `best_pair`, both scaled so that the area is the polygon's.
FootprintPair polygon_pair(std::span<const glm::dvec2> vectors);

/// The axes of the second moments: A, B = sqrt(lambda_i) e_i of sum v v^T, A the longer one. A box
/// on them has the moments of the sum of the boxes. Extent grows like the root of the number of
/// vectors: for filters.
FootprintPair rms_pair(std::span<const glm::dvec2> vectors);

/// Singular values of (A B): semi-axes of the ellipse that the unit circle becomes.
struct PairExtent {
    double major = 0, minor = 0;
};

PairExtent pair_extent(const FootprintPair& pair);

}  // namespace opaline::bake
