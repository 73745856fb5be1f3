#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/media.h"

namespace opaline::tests {

/// A body's surface and what fills it.
using Part = std::pair<Primitive, formats::Medium>;

/// One material for each part.
inline Scene make_nested_scene(std::vector<Part> parts) {
    std::vector<Primitive> surfaces;
    for (std::uint32_t m = 0; m < parts.size(); ++m) {
        surfaces.push_back(std::move(parts[m].first));
        surfaces.back().material = m;
    }
    Scene scene = make_scene(std::move(surfaces));
    scene.materials.resize(parts.size(), scene.materials[0]);
    for (std::size_t m = 0; m < parts.size(); ++m) {
        scene.materials[m].name = "Part " + std::to_string(m);
        scene.materials[m].medium = parts[m].second;
    }
    return scene;
}

/// Bodies of cells between the lines of a grid, the same along all axes: `is_solid(i, j, k)`. Each
/// cell's face has vertices of its own.
template <class IsSolid>
Primitive make_cells(const std::vector<float>& line, IsSolid&& is_solid) {
    const int n = static_cast<int>(line.size()) - 1;
    const auto solid = [&](glm::ivec3 c) {
        for (int a = 0; a < 3; ++a) {
            if (c[a] < 0 || c[a] >= n) return false;
        }
        return is_solid(c.x, c.y, c.z);
    };
    Primitive body;
    for (int cell = 0; cell < n * n * n; ++cell) {
        const glm::ivec3 c(cell % n, cell / n % n, cell / (n * n));
        if (!solid(c)) continue;
        for (int a = 0; a < 3; ++a) {
            for (const int side : {-1, 1}) {
                glm::ivec3 beside = c;
                beside[a] += side;
                if (solid(beside)) continue;
                const int u = (a + (side > 0 ? 1 : 2)) % 3, v = (a + (side > 0 ? 2 : 1)) % 3;
                const auto first = static_cast<std::uint32_t>(body.position.size());
                glm::vec3 normal(0);
                normal[a] = static_cast<float>(side);
                for (const auto& [du, dv] :
                     {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
                    glm::ivec3 corner = c;
                    corner[a] += side > 0 ? 1 : 0;
                    corner[u] += du;
                    corner[v] += dv;
                    body.position.emplace_back(line[static_cast<std::size_t>(corner.x)],
                                               line[static_cast<std::size_t>(corner.y)],
                                               line[static_cast<std::size_t>(corner.z)]);
                    body.normal.push_back(normal);
                }
                for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
                    body.index.push_back(first + k);
                }
            }
        }
    }
    return body;
}

/// A box whose faces are cut into n x n.
inline Primitive make_box(glm::vec3 low, glm::vec3 high, int n) {
    std::vector<float> line;
    for (int i = 0; i <= n; ++i) {
        line.push_back(static_cast<float>(i) / static_cast<float>(n));
    }
    Primitive box = make_cells(line, [](int, int, int) { return true; });
    for (glm::vec3& p : box.position) {
        p = low + (high - low) * p;
    }
    return box;
}

/// Half as wide and high as 1, with walls a tenth of that thick, and open above.
inline Primitive make_cup() {
    const std::vector<float> line{-1, -0.9f, -0.3f, 0.3f, 0.9f, 1};
    return make_cells(
        line, [](int x, int y, int z) { return x == 0 || x == 4 || z == 0 || z == 4 || y == 0; });
}

/// What fills the cup, but for so much on all sides; less than 0: it reaches into the walls.
inline Primitive make_drink(float gap) {
    const float wall = 0.9f - gap;
    return make_box({-wall, -wall, -wall}, {wall, 0.5f, wall}, 5);
}

/// Clear, with a boundary that loses no light between facets.
inline formats::Medium make_smooth_glass(float eta) {
    formats::Medium glass = make_grey_medium(0, 0, eta);
    glass.roughness = 0;
    return glass;
}

/// Several bodies that absorb nothing: everything shows what an even sky shows.
struct BodiesThatMeet {
    std::string name;
    std::vector<Part> parts;  ///< a material each
};

inline std::vector<BodiesThatMeet> make_bodies_that_meet() {
    const formats::Medium milk = make_grey_medium(20, 0, 1.33f), wax = make_grey_medium(9, 0, 1.5f),
                          glass = make_smooth_glass(1.5f), ice = make_smooth_glass(1.31f);
    const Primitive low = make_box({-1, -1, -1}, {1, 0, 1}, 4);
    return {{"StackedWithFacesOfOtherTriangles",
             {{low, milk}, {make_box({-1, 0, -1}, {1, 1, 1}, 3), wax}}},
            {"StackedWithTheSameFace", {{low, milk}, {make_box({-1, 0, -1}, {1, 1, 1}, 4), wax}}},
            {"StackedOfOneMedium", {{low, milk}, {make_box({-1, 0, -1}, {1, 1, 1}, 3), milk}}},
            {"OverlappingWithFacesInOnePlane",
             {{low, milk}, {make_box({-0.5f, -0.5f, -1}, {1, 1, 1}, 4), wax}}},
            {"CubeHalfInsideAnother",
             {{low, milk}, {make_box({-0.4f, -0.3f, -0.4f}, {0.4f, 0.3f, 0.4f}, 3), wax}}},
            {"DrinkInTheWallOfItsGlass", {{make_cup(), glass}, {make_drink(-0.04f), milk}}},
            {"DrinkFlushWithItsGlass", {{make_cup(), glass}, {make_drink(0), milk}}},
            {"DrinkOffItsGlass", {{make_cup(), glass}, {make_drink(0.02f), milk}}},
            {"IceThatPokesOutOfGlass",
             {{make_box({-1, -1, -1}, {1, 1, 1}, 4), glass},
              {make_box({-0.4f, 0.3f, -0.4f}, {0.4f, 1.2f, 0.4f}, 3), ice}}}};
}

}  // namespace opaline::tests
