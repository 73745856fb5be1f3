#pragma once

#include <cmath>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// A ball of 80 000 triangles with dents, of a medium whose mean free path is a fiftieth of its
/// diameter.
inline Scene make_dented_ball() {
    auto ball = make_sphere(6);
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        const glm::vec3 n = ball.normal[v];
        ball.position[v] +=
            0.08f * std::sin(13 * n.x) * std::sin(11 * n.y) * std::sin(12 * n.z) * n;
    }
    auto scene = make_scene({ball});
    formats::Medium medium;
    medium.sigma_s = {22, 24, 20};
    medium.sigma_a = {3, 1, 5};
    medium.eta = 1.3f;
    scene.materials[0].medium = medium;
    return scene;
}

}  // namespace opaline::tests
