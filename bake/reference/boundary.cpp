#include "bake/reference/boundary.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {

BoundarySplit split_at_boundary(glm::vec3 direction, glm::vec3 normal, float ratio) {
    const double n = static_cast<double>(ratio);
    const double c = std::clamp(-static_cast<double>(glm::dot(direction, normal)), 0.0, 1.0);
    BoundarySplit split;
    split.reflected = glm::normalize(direction + 2 * static_cast<float>(c) * normal);
    // Snell: n sin t = sin i; (n cos t)^2 = n^2 - 1 + c^2.
    const double squared = (n - 1) * (n + 1) + c * c;
    if (squared <= 0) {
        split.reflectance = 1;
        return split;
    }
    const double behind = std::sqrt(squared);  // n cos t
    const double s = (c - behind) / (c + behind);
    const double p = (n * n * c - behind) / (n * n * c + behind);
    split.reflectance = static_cast<float>(std::min(1.0, 0.5 * (s * s + p * p)));
    const auto along = static_cast<float>((c - behind) / n);
    split.transmitted = glm::normalize(direction / ratio + along * normal);
    return split;
}

BoundarySplit split_at_smooth_boundary(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat,
                                       float ratio) {
    if (glm::dot(direction, smooth) < 0) {
        const BoundarySplit split = split_at_boundary(direction, smooth, ratio);
        const bool total = split.reflectance >= 1;
        if (glm::dot(split.reflected, flat) > 0 &&
            (total || glm::dot(split.transmitted, flat) < 0)) {
            return split;
        }
    }
    return split_at_boundary(direction, flat, ratio);
}

}  // namespace opaline::bake
