#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "formats/scene.h"

namespace opaline::tests {

using formats::Primitive;
using formats::Scene;

inline Scene make_scene(std::vector<Primitive> primitives) {
    Scene scene;
    scene.source = "test scene";
    scene.materials.push_back({.name = "Grey"});
    scene.primitives = std::move(primitives);
    return scene;
}

/// Unit sphere from an icosahedron, each level with four times the triangles; smooth normals.
inline Primitive make_sphere(int levels, float radius = 1, glm::vec3 centre = {}) {
    const float t = std::numbers::phi_v<float>;
    Primitive p;
    p.name = "sphere";
    for (const glm::vec3 v : {glm::vec3(-1, t, 0),
                              {1, t, 0},
                              {-1, -t, 0},
                              {1, -t, 0},
                              {0, -1, t},
                              {0, 1, t},
                              {0, -1, -t},
                              {0, 1, -t},
                              {t, 0, -1},
                              {t, 0, 1},
                              {-t, 0, -1},
                              {-t, 0, 1}}) {
        p.normal.push_back(glm::normalize(v));
    }
    p.index = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
               4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
               6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
        std::vector<std::uint32_t> finer;
        const auto between = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, added] =
                middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p.normal.size()));
            if (added) {
                p.normal.push_back(glm::normalize(p.normal[a] + p.normal[b]));
            }
            return it->second;
        };
        for (std::size_t i = 0; i < p.index.size(); i += 3) {
            const std::uint32_t a = p.index[i], b = p.index[i + 1], c = p.index[i + 2];
            const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        p.index = std::move(finer);
    }
    for (const glm::vec3& n : p.normal) {
        p.position.push_back(centre + radius * n);
    }
    return p;
}

/// Parallelogram corner + s a + t b, s and t in [0, 1], cut into cells x cells; normal along
/// cross(a, b).
inline Primitive make_quad(glm::vec3 corner, glm::vec3 a, glm::vec3 b, std::uint32_t cells = 1) {
    Primitive p;
    p.name = "quad";
    const glm::vec3 normal = glm::normalize(glm::cross(a, b));
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const float s = static_cast<float>(i) / static_cast<float>(cells);
            const float t = static_cast<float>(j) / static_cast<float>(cells);
            p.position.push_back(corner + s * a + t * b);
            p.normal.push_back(normal);
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t v = j * (cells + 1) + i;
            p.index.insert(p.index.end(),
                           {v, v + 1, v + cells + 2, v, v + cells + 2, v + cells + 1});
        }
    }
    return p;
}

/// Cube [-1, 1]^3, each side cut into cells x cells, sides not sharing vertices.
inline Primitive make_cube(std::uint32_t cells, bool inward) {
    Primitive all;
    all.name = "cube";
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 n(0), a(0), b(0);
            n[axis] = side;
            a[(axis + 1) % 3] = 2;
            b[(axis + 2) % 3] = 2;
            if ((side > 0) == inward) {
                std::swap(a, b);
            }
            const Primitive quad = make_quad(n - 0.5f * (a + b), a, b, cells);
            const auto base = static_cast<std::uint32_t>(all.position.size());
            all.position.insert(all.position.end(), quad.position.begin(), quad.position.end());
            all.normal.insert(all.normal.end(), quad.normal.begin(), quad.normal.end());
            for (const std::uint32_t i : quad.index) {
                all.index.push_back(base + i);
            }
        }
    }
    return all;
}

/// Disc of radius r facing down (-y) at a height over the origin.
inline Primitive make_disc(float radius, float height, std::uint32_t segments) {
    Primitive p;
    p.name = "disc";
    p.position.push_back({0, height, 0});
    for (std::uint32_t i = 0; i < segments; ++i) {
        const double phi = 2 * std::numbers::pi * i / segments;
        p.position.push_back({radius * std::cos(phi), height, radius * std::sin(phi)});
        p.index.insert(p.index.end(), {0, i + 1, (i + 1) % segments + 1});
    }
    p.normal.assign(p.position.size(), {0, -1, 0});
    return p;
}

/// The primitive turned, scaled and moved: p -> scale * rotation * p + offset.
inline Primitive transformed(Primitive p, const glm::mat3& rotation, float scale,
                             glm::vec3 offset) {
    for (std::size_t v = 0; v < p.position.size(); ++v) {
        p.position[v] = scale * (rotation * p.position[v]) + offset;
        p.normal[v] = glm::normalize(rotation * p.normal[v]);
    }
    return p;
}

inline glm::mat3 some_rotation() {
    return glm::mat3(glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(0.3f, 1, -0.4f))));
}

}  // namespace opaline::tests
