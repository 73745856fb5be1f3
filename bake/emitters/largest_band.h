#pragma once

#include <algorithm>
#include <glm/glm.hpp>

namespace opaline::bake {

inline double largest_band(const glm::dvec3& of) {
    return std::max({of.x, of.y, of.z});
}

}  // namespace opaline::bake
