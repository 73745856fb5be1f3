#pragma once

#include <vector>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// A closed sheet of 2 x 2 m across y, top and bottom face first, with more vertices on its faces
/// than around its rim. Six primitives of one material.
inline std::vector<Primitive> make_sheet(float thickness, std::uint32_t cells = 8) {
    const glm::vec3 up(0, thickness, 0), x(2, 0, 0), z(0, 0, 2), low(-1, -0.5f * thickness, -1);
    return {
        make_quad(low + up, z, x, cells), make_quad(low, x, z, cells), make_quad(low, up, x),
        make_quad(low + z, x, up),        make_quad(low, z, up),       make_quad(low + x, up, z)};
}

}  // namespace opaline::tests
