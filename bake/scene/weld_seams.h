#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// New positions of some vertices of a primitive.
struct WeldedVertices {
    std::size_t primitive = 0;
    std::vector<glm::vec3> position;  ///< [m], of all of its vertices
};

/// Closes seams that rounding opened: vertices of the primitives with a material of `chosen` that
/// are nearer to each other than a part in 10^6 of the smallest of these primitives, or than four
/// steps of their coordinates, come to lie at one position, that of the first of them. Only the
/// primitives that change are in the result.
std::vector<WeldedVertices> weld_seams(const formats::Scene& scene,
                                       const std::vector<bool>& chosen);

}  // namespace opaline::bake
