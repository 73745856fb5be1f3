#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Key and hash of a position. Vertices at one position are one point of the surface, however often
/// a file repeats them; -0 and +0 have the same key.
inline glm::vec3 weld_key(glm::vec3 position) {
    return position + 0.0f;
}

struct PositionHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::uint64_t h = 0x9e3779b97f4a7c15u;
        for (const float x : {p.x, p.y, p.z}) {
            h = (h ^ std::bit_cast<std::uint32_t>(x)) * 0xff51afd7ed558ccdu;
            h ^= h >> 32;
        }
        return h;
    }
};

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
