#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

namespace opaline::bake {

/// Direction `i` of `count` that cover the sphere evenly, turned by two numbers in [0, 1).
inline glm::vec3 even_direction(std::uint32_t i, std::uint32_t count, float u, float v) {
    constexpr double kGolden = 0.61803398874989485;
    const double z =
        1 - 2 * (static_cast<double>(i) + static_cast<double>(u)) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * kGolden + static_cast<double>(v);
    const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return glm::vec3(glm::dvec3(r * std::cos(angle), r * std::sin(angle), z));
}

}  // namespace opaline::bake
