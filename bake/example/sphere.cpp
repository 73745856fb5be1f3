#include "bake/example/sphere.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

namespace opaline::bake {
namespace {

TriangleMesh make_icosahedron() {
    constexpr double g = std::numbers::phi;
    TriangleMesh mesh;
    mesh.normal = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (glm::dvec3& n : mesh.normal) {
        n = glm::normalize(n);
    }
    return mesh;
}

// Normals are all that counts here: on the unit sphere they are the positions.
void subdivide(TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, added] =
            middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.normal.size()));
        if (added) {
            mesh.normal.push_back(glm::normalize(mesh.normal[a] + mesh.normal[b]));
        }
        return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
}

}  // namespace

TriangleMesh make_sphere(glm::dvec3 centre, double radius, unsigned levels) {
    TriangleMesh mesh = make_icosahedron();
    for (unsigned level = 0; level < levels; ++level) {
        subdivide(mesh);
    }
    for (const glm::dvec3& n : mesh.normal) {
        mesh.position.push_back(centre + radius * n);
    }
    return mesh;
}

}  // namespace opaline::bake
