#include "bake/reference/boundary.h"

#include <algorithm>
#include <cmath>
#include <optional>

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
    // Nothing if the normal faces away, or sends a ray to the wrong side.
    const auto split_at = [&](glm::vec3 normal) -> std::optional<BoundarySplit> {
        if (!(glm::dot(direction, normal) < 0)) {
            return std::nullopt;
        }
        const BoundarySplit split = split_at_boundary(direction, normal, ratio);
        const bool fits = glm::dot(split.reflected, flat) > 0 &&
                          (split.reflectance >= 1 || glm::dot(split.transmitted, flat) < 0);
        return fits ? std::optional(split) : std::nullopt;
    };
    if (const auto split = split_at(smooth)) {
        return *split;
    }
    BoundarySplit nearest = split_at_boundary(direction, flat, ratio);
    float wrong = 0, right = 1;  // share of the triangle's normal
    constexpr int kHalvings = 20;
    for (int i = 0; i < kHalvings; ++i) {
        const float middle = 0.5f * (wrong + right);
        if (const auto split = split_at(glm::normalize(glm::mix(smooth, flat, middle)))) {
            nearest = *split;
            right = middle;
        } else {
            wrong = middle;
        }
    }
    return nearest;
}

}  // namespace opaline::bake
