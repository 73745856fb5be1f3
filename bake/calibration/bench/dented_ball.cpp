#include "bake/calibration/bench/dented_ball.h"

#include <cmath>
#include <utility>

namespace opaline::bake {
namespace {

glm::vec3 dented(glm::vec3 n) {
    return (1 + 0.12f * std::sin(9 * n.x) * std::sin(8 * n.y) * std::sin(7 * n.z)) * n;
}

// From central differences of the surface along two directions.
glm::vec3 normal_at(glm::vec3 n) {
    constexpr float kStep = 1e-2f;
    const glm::vec3 helper = std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 u = kStep * glm::normalize(glm::cross(helper, n));
    const glm::vec3 v = glm::cross(n, u);
    return glm::normalize(
        glm::cross(dented(glm::normalize(n + u)) - dented(glm::normalize(n - u)),
                   dented(glm::normalize(n + v)) - dented(glm::normalize(n - v))));
}

// One side of the cube that is mapped to the ball.
void append_side(formats::Primitive& p, glm::length_t axis, float sign, std::uint32_t n) {
    const auto base = static_cast<std::uint32_t>(p.position.size());
    const glm::length_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            // Exact at the edges, so that neighbouring sides share positions.
            const auto at = [n](std::uint32_t k) {
                return (2 * static_cast<float>(k) - static_cast<float>(n)) / static_cast<float>(n);
            };
            glm::vec3 cube;
            cube[axis] = sign;
            cube[u] = sign * at(i);
            cube[v] = at(j);
            const glm::vec3 out = glm::normalize(cube);
            p.position.push_back(dented(out));
            p.normal.push_back(normal_at(out));
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = base + j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            p.index.insert(p.index.end(), {a, b, d, a, d, c});
        }
    }
}

}  // namespace

formats::Scene make_dented_ball(std::uint32_t n) {
    formats::Primitive ball;
    ball.name = "dented ball";
    for (const glm::length_t axis : {0, 1, 2}) {
        append_side(ball, axis, 1.0f, n);
        append_side(ball, axis, -1.0f, n);
    }
    formats::Scene scene;
    scene.source = "calibration";
    scene.materials.push_back({.name = "Ball"});
    formats::Medium medium;
    medium.sigma_s = {88, 96, 80};
    medium.sigma_a = {12, 4, 20};
    medium.profile = formats::Medium::Profile::classic;  // needs no random walk
    scene.materials[0].medium = medium;
    scene.primitives.push_back(std::move(ball));
    return scene;
}

}  // namespace opaline::bake
