#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>

#include "bake/path_integral/probe_depth.h"
#include "bake/path_integral/quasi_path.h"
#include "bake/path_integral/zonal_table.h"

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

/// A point and two directions.
struct PathQuery {
    glm::dvec3 position{0};      ///< [m], in the limits' box
    glm::dvec3 onward{0, 0, 1};  ///< unit; from `position` away from the eye
    glm::dvec3 light{0, 0, 1};   ///< unit; toward the distant light
};

/// Light from afar that a medium scatters toward the eye [1/sr, per unit irradiance measured
/// perpendicular to its direction]: two scatterings or more. Table of PathKernel::ray: radiance at
/// the position, corrected [Premoze2003] (18) with the sum over directions in closed form
/// (README.md, "Radiance"). Of PathKernel::source: radiance scattered at the position, per unit b.
/// The mean over paths whose turns end at `lengths` times the scattering depth onward; at least one
/// length, > 0. An estimate: the error of the model is 10 to 30 % (README.md, "Accuracy").
template <class Medium, class Visibility>
double estimate_scattered(const ZonalTable& table, const PathQuery& query, const Medium& medium,
                          const MarchLimits& limits, std::span<const double> lengths,
                          const Visibility& visibility) {
    const auto scattering = [&](glm::dvec3 x) { return Coefficients(medium(x)).scattering; };
    const double onward =
        probe_depth(scattering, limits.box, query.position, query.onward, limits.step);
    const ZonalRow kernel = interpolate_row(table, glm::dot(query.onward, query.light));
    const Turns turns(query.onward, query.light);
    double sum = 0;
    for (const double length : lengths) {
        const double ell_total = std::max(length * onward, kShortestTurn);
        for (const Turn& turn : turns) {
            sum += gather_along_path({query.position, turn, ell_total}, medium, limits, kernel,
                                     visibility);
        }
    }
    return sum / static_cast<double>(lengths.size() * turns.size());
}

}  // namespace opaline::bake
