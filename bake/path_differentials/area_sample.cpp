#include "bake/path_differentials/area_sample.h"

#include <cmath>

namespace opaline::bake {

AreaSample sample_triangle_folded(const std::array<glm::dvec3, 3>& corners, double u, double v) {
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    if (v > u) {
        return {corners[0] + u / 2 * e1 + (v - u / 2) * e2, (e1 - e2) / 2.0, e2};
    }
    return {corners[0] + (u - v / 2) * e1 + v / 2 * e2, e1, (e2 - e1) / 2.0};
}

AreaSample sample_triangle_sqrt(const std::array<glm::dvec3, 3>& corners, double u, double v) {
    const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const glm::dvec3 across = (1 - v) * e1 + v * e2;
    const double root = std::sqrt(u);
    return {corners[0] + root * across, across / (2 * root), root * (e2 - e1)};
}

}  // namespace opaline::bake
