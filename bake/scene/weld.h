#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>

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

}  // namespace opaline::bake
