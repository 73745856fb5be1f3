#pragma once

#include <glm/glm.hpp>

#include <cmath>

#include "bake/physics/path_integral/quasi_path.h"
#include "bake/physics/path_integral/volume_box.h"

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
    if (!(count > 0)) return 0;
    const double ds = length / count;
    double sum = 0;
    for (double i = 0; i < count; ++i) {
        sum += coefficient(x + (i + 0.5) * ds * direction);
    }
    return sum * ds;
}

/// Share of light that survives absorption below which a path is given up.
inline constexpr double kLeastSurvival = 1e-8;

/// int b e^-A kappa(ell) V(x) ds along a path: light that arrives from afar along the path's last
/// direction and is scattered for the last time on the path [1/sr, per unit irradiance measured
/// perpendicular to that direction]. `kernel`: double(double ell) [1/sr]; `visibility`:
/// double(glm::dvec3 x), the share of that light that reaches x unscattered, in [0, 1].
template <class Medium, class Kernel, class Visibility>
double gather_along_path(const QuasiPath& path, const Medium& medium, const MarchLimits& limits,
                         const Kernel& kernel, const Visibility& visibility) {
    double sum = 0;
    march_quasi_path(path, medium, limits, [&](const PathStep& step) {
        const double survival = std::exp(-step.absorption);
        if (step.depth > 0) {
            sum += step.depth * survival * kernel(step.ell) * visibility(step.position);
        }
        return survival > kLeastSurvival;
    });
    return sum;
}

}  // namespace opaline::bake
