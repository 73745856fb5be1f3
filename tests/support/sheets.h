#pragma once

#include <vector>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// A plate of `width` x `width` across y whose faces and rim are cut alike, so that its edges
/// close.
inline Primitive make_plate(float thickness, std::uint32_t cells = 4, float width = 2) {
    Primitive plate = make_cube(cells, false);
    for (glm::vec3& p : plate.position) {
        p *= 0.5f * glm::vec3(width, thickness, width);
    }
    return plate;
}

/// The same with more vertices on its faces, top and bottom first, than around its rim: edges of
/// its six primitives do not match, and it counts as open.
inline std::vector<Primitive> make_sheet(float thickness, std::uint32_t cells = 8,
                                         float width = 2) {
    const glm::vec3 up(0, thickness, 0), x(width, 0, 0), z(0, 0, width);
    const glm::vec3 low = -0.5f * (up + x + z);
    return {
        make_quad(low + up, z, x, cells), make_quad(low, x, z, cells), make_quad(low, up, x),
        make_quad(low + z, x, up),        make_quad(low, z, up),       make_quad(low + x, up, z)};
}

}  // namespace opaline::tests
