#pragma once

#include <vector>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// A closed sheet of `width` x `width` across y, top and bottom face first, with more vertices on
/// its faces than around its rim. Six primitives of one material.
inline std::vector<Primitive> make_sheet(float thickness, std::uint32_t cells = 8,
                                         float width = 2) {
    const glm::vec3 up(0, thickness, 0), x(width, 0, 0), z(0, 0, width);
    const glm::vec3 low = -0.5f * (up + x + z);
    return {
        make_quad(low + up, z, x, cells), make_quad(low, x, z, cells), make_quad(low, up, x),
        make_quad(low + z, x, up),        make_quad(low, z, up),       make_quad(low + x, up, z)};
}

}  // namespace opaline::tests
