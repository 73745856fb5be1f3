#include "bake/scene/nearest_grid.h"

#include <array>

#include "bake/base/parallel_indices.h"

namespace opaline::bake {
namespace {

using Place = NearestSurface::Place;

glm::vec3 point_of(const formats::Scene& scene, const Place& place) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    const auto corner = [&](std::uint32_t k) { return p.position[p.index[place.first_index + k]]; };
    return corner(0) + place.u * (corner(1) - corner(0)) + place.v * (corner(2) - corner(0));
}

// The thirteen neighbours that come before a node in the order of the nodes.
constexpr std::array<std::array<int, 3>, 13> kBefore{{{-1, 0, 0},
                                                      {-1, -1, 0},
                                                      {0, -1, 0},
                                                      {1, -1, 0},
                                                      {-1, -1, -1},
                                                      {0, -1, -1},
                                                      {1, -1, -1},
                                                      {-1, 0, -1},
                                                      {0, 0, -1},
                                                      {1, 0, -1},
                                                      {-1, 1, -1},
                                                      {0, 1, -1},
                                                      {1, 1, -1}}};

struct Propagation {
    const GridNodes& nodes;
    std::vector<Place>& places;
    std::vector<glm::vec3> points;  // of the places

    // Each node takes the nearest of what the neighbours before it have, in the order of the nodes
    // or against it.
    void sweep(bool backward) {
        const glm::ivec3 count(nodes.count);
        const std::size_t all = nodes.size();
        for (std::size_t k = 0; k < all; ++k) {
            const std::size_t i = backward ? all - 1 - k : k;
            const auto x = static_cast<int>(i % nodes.count.x);
            const auto y = static_cast<int>(i / nodes.count.x % nodes.count.y);
            const auto z = static_cast<int>(i / nodes.count.x / nodes.count.y);
            for (const auto& [dx, dy, dz] : kBefore) {
                const glm::ivec3 n =
                    glm::ivec3(x, y, z) + (backward ? -1 : 1) * glm::ivec3(dx, dy, dz);
                if (glm::all(glm::greaterThanEqual(n, glm::ivec3(0))) &&
                    glm::all(glm::lessThan(n, count))) {
                    const glm::uvec3 from(n);
                    take(i, glm::uvec3(x, y, z), nodes.index(from.x, from.y, from.z));
                }
            }
        }
    }

    void take(std::size_t to, glm::uvec3 at, std::size_t from) {
        if (places[from].primitive == formats::kNone) {
            return;
        }
        const float distance = glm::distance(nodes.position(at.x, at.y, at.z), points[from]);
        if (places[to].primitive == formats::kNone || distance < places[to].distance) {
            places[to] = places[from];
            places[to].distance = distance;
            points[to] = points[from];
        }
    }
};

}  // namespace

std::vector<Place> find_nearest(const formats::Scene& scene, const NearestSurface& surface,
                                const GridNodes& nodes) {
    constexpr float kNear = 1.9f;  // cells: every cell that the surface crosses has its own
    std::vector<Place> places(nodes.size());
    Propagation propagation{nodes, places, std::vector<glm::vec3>(nodes.size())};
    for_each_index(nodes.count.z, [&](std::size_t slice) {
        const auto z = static_cast<std::uint32_t>(slice);
        for (std::uint32_t y = 0; y < nodes.count.y; ++y) {
            for (std::uint32_t x = 0; x < nodes.count.x; ++x) {
                const std::size_t i = nodes.index(x, y, z);
                places[i] = surface.find(nodes.position(x, y, z), kNear * nodes.cell);
                if (places[i].primitive != formats::kNone) {
                    propagation.points[i] = point_of(scene, places[i]);
                }
            }
        }
    });
    propagation.sweep(false);
    propagation.sweep(true);
    return places;
}

}  // namespace opaline::bake
