#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace opaline::bake {

inline double fraction(double x) {
    return x - std::floor(x);
}

/// Point i of a sequence of low discrepancy in the unit square [Roberts2018], shifted.
inline glm::dvec2 spread_point(const glm::dvec2& shift, std::uint32_t i) {
    return {fraction(shift.x + i * 0.7548776662466927), fraction(shift.y + i * 0.5698402909980532)};
}

/// Which part of a cumulative sum `at` falls into; at least one part.
inline std::size_t part_of_sum(std::span<const double> cumulative, double at) {
    const auto part = std::ranges::upper_bound(cumulative, at) - cumulative.begin();
    return std::min(static_cast<std::size_t>(part), cumulative.size() - 1);
}

}  // namespace opaline::bake
