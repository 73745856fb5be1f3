#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace opaline::bake {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

double smoothstep(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// From 0 in the joint to 1 on the brick's face; `at` in [0, 1] across the brick.
double rise(double at, double bevel) {
    return smoothstep(std::min(at, 1 - at) / bevel);
}

// In tiles, at a point of the tile: u in [0, 1] to the right, v downward.
double brick_height(double u, double v) {
    constexpr double kDepth = 0.018;
    const double course = std::floor(4 * v);
    const double along = 2 * u + (static_cast<int>(course) % 2 == 0 ? 0.0 : 0.5);
    const double face = rise(along - std::floor(along), 0.08) * rise(4 * v - course, 0.16);
    // Waves that fit the tile, of no common direction.
    struct Wave {
        int u, v;
        double phase, height;
    };
    constexpr std::array<Wave, 8> kWaves{{{5, 3, 0.3, 5e-4},
                                          {-7, 4, 1.9, 4e-4},
                                          {11, -6, 4.2, 3e-4},
                                          {3, 13, 2.5, 3e-4},
                                          {-17, -9, 5.1, 2e-4},
                                          {14, 16, 0.9, 2e-4},
                                          {23, -11, 3.3, 1.2e-4},
                                          {-8, 25, 1.2, 1.2e-4}}};
    double rough = 0;
    for (const Wave& wave : kWaves) {
        rough += wave.height * std::cos(2 * kHalfTurn * (wave.u * u + wave.v * v) + wave.phase);
    }
    return kDepth * face + rough;
}

std::uint8_t code(double x) {
    return static_cast<std::uint8_t>(std::lround(128 + 127 * std::clamp(x, -1.0, 1.0)));
}

}  // namespace

MappedMesh make_panel(glm::dvec3 corner, glm::dvec3 a, glm::dvec3 b, unsigned cells, double tile) {
    MappedMesh panel;
    append_grid(panel.mesh, cells, cells, corner, a, b);
    for (unsigned j = 0; j <= cells; ++j) {
        for (unsigned i = 0; i <= cells; ++i) {
            const double s = static_cast<double>(i) / cells, t = static_cast<double>(j) / cells;
            panel.texcoord.emplace_back(s * glm::length(a) / tile, -t * glm::length(b) / tile);
        }
    }
    return panel;
}

MappedMesh make_mapped_ball(glm::dvec3 centre, double radius) {
    constexpr unsigned kAround = 64, kDown = 32;
    MappedMesh ball;
    for (unsigned j = 0; j <= kDown; ++j) {
        for (unsigned i = 0; i <= kAround; ++i) {
            const double up = static_cast<double>(j) / kDown,
                         turn = static_cast<double>(i) / kAround;
            const double polar = kHalfTurn * (1 - up), azimuth = 2 * kHalfTurn * turn;
            const glm::dvec3 normal(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                    std::sin(polar) * std::cos(azimuth));
            ball.mesh.position.push_back(centre + radius * normal);
            ball.mesh.normal.push_back(normal);
            ball.texcoord.emplace_back(4 * turn, -2 * up);
        }
    }
    join_grid(ball.mesh, kAround, kDown);
    std::erase_if(ball.mesh.triangles, [&](const Triangle& t) {  // at the poles
        const auto& at = ball.mesh.position;
        return glm::length(glm::cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]])) <
               1e-9 * radius * radius;
    });
    return ball;
}

formats::Image8 paint_brick_normals() {
    constexpr std::uint32_t kPixels = 256;
    constexpr double kStep = 0.5 / kPixels;
    formats::Image8 image{kPixels, kPixels, {}};
    image.rgba.reserve(std::size_t{4} * kPixels * kPixels);
    for (std::uint32_t row = 0; row < kPixels; ++row) {
        for (std::uint32_t column = 0; column < kPixels; ++column) {
            const double u = (column + 0.5) / kPixels, v = (row + 0.5) / kPixels;
            const double du =
                (brick_height(u + kStep, v) - brick_height(u - kStep, v)) / (2 * kStep);
            const double dv =
                (brick_height(u, v + kStep) - brick_height(u, v - kStep)) / (2 * kStep);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-du, dv, 1));
            image.rgba.insert(image.rgba.end(),
                              {code(normal.x), code(normal.y), code(normal.z), 255});
        }
    }
    return image;
}

}  // namespace opaline::bake
