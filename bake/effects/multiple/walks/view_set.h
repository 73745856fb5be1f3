#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/multiple/walks/view_fit.h"

namespace opaline::bake {

/// Views of a receiver and what each adds to its rows (README.md, "Views"): a quadrature of uniform
/// light that enters through the boundary and, where there are rows by view, the normal.
struct ViewSet {
    std::vector<glm::vec3> into;  ///< unit, inside, away from the eye
    /// With T(view) the light seen along each: T_0 = sum of share[0] T, row r by view = sum of
    /// share[r] T.
    std::vector<std::array<float, 1 + kAllDegrees>> share;
};

/// `eta` > 0 of the boundary, `fit` made for it, `normal` unit, `rows` 1, 4 or 9. T_0 is the mean
/// over the light that enters. The rows by view are the least-squares fit of T - T_0, half of the
/// weight on that light and half on the normal alone, so that views along the normal have a smaller
/// error than others.
ViewSet make_view_set(const ViewFit& fit, double eta, glm::vec3 normal, std::uint32_t rows);

}  // namespace opaline::bake
