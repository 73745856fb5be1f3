#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "bake/path_integral/volume_box.h"

namespace opaline::bake {

/// Depth int f ds along a ray from `x` in a finite box to where the ray leaves it, by the midpoint
/// rule in equal steps of at most `step` [m], of second order. `coefficient`: f(glm::dvec3) [1/m],
/// scattering for the depth in which a path turns, extinction for the optical depth. `direction`:
/// unit; `step` > 0.
template <class Coefficient>
double probe_depth(const Coefficient& coefficient, const VolumeBox& box, glm::dvec3 x,
                   glm::dvec3 direction, double step) {
    const double length = exit_distance(box, x, direction);
    const double count = std::ceil(length / step);
    if (!(count > 0)) {
        return 0;
    }
    const double ds = length / count;
    double sum = 0;
    for (double i = 0; i < count; ++i) {
        sum += coefficient(x + (i + 0.5) * ds * direction);
    }
    return sum * ds;
}

}  // namespace opaline::bake
