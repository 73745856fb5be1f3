#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "bake/path_integral/quasi_path.h"

namespace opaline::bake {

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
