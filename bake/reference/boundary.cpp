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

glm::vec3 fitting_normal(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat) {
    // A ray in the triangle's plane meets the triangles beside it by rounding.
    constexpr float kLeastSine = 1e-3f;
    const auto reflects_in_front = [&](glm::vec3 normal) {
        const float along = glm::dot(direction, normal);
        return along < 0 && glm::dot(direction - 2 * along * normal, flat) > kLeastSine;
    };
    glm::vec3 normal = smooth;
    if (!reflects_in_front(smooth)) {
        normal = flat;
        float wrong = 0, right = 1;  // share of the triangle's normal
        constexpr int kHalvings = 20;
        for (int i = 0; i < kHalvings; ++i) {
            const float middle = 0.5f * (wrong + right);
            const glm::vec3 turned = glm::normalize(glm::mix(smooth, flat, middle));
            const bool fits = reflects_in_front(turned);
            normal = fits ? turned : normal;
            (fits ? right : wrong) = middle;
        }
    }
    return normal;
}

BoundarySplit split_at_smooth_boundary(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat,
                                       float ratio) {
    BoundarySplit split =
        split_at_boundary(direction, fitting_normal(direction, smooth, flat), ratio);
    if (split.reflectance < 1 && !(glm::dot(split.transmitted, flat) < 0)) {
        split.reflectance = 1;  // beyond the angle of the triangle's own total reflection
    }
    return split;
}

}  // namespace opaline::bake
