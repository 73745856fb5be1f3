#include "bake/example/contact.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace opaline::bake {
namespace {

// The point between a and b, on opposite sides of the solid's surface, where it is crossed.
glm::dvec3 find_crossing(const Field& solid, glm::dvec3 inside, glm::dvec3 outside, double gap) {
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 middle = 0.5 * (inside + outside);
        (solid(middle) < gap ? inside : outside) = middle;
    }
    return outside;
}

// Signed area [mm^2] seen from above, +y.
double area_from_above(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return 0.5 * ((c.x - a.x) * (b.z - a.z) - (b.x - a.x) * (c.z - a.z));
}

// Makes the moves, short ones first, leaving out those that would crush a triangle or turn it over.
void move_vertices(const std::vector<double>& distance, const std::vector<glm::dvec3>& target,
                   TriangleMesh& floor) {
    constexpr double kLeastShare = 0.1;  // of a triangle's area
    std::vector<std::vector<std::size_t>> around(distance.size());
    std::vector<double> least_area;
    for (const auto& [a, b, c] : floor.triangles) {
        for (const std::uint32_t v : {a, b, c}) {
            around[v].push_back(least_area.size());
        }
        least_area.push_back(
            kLeastShare * area_from_above(floor.position[a], floor.position[b], floor.position[c]));
    }
    std::vector<std::size_t> order(distance.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    for (const std::size_t v : order) {
        const glm::dvec3 before = std::exchange(floor.position[v], target[v]);
        for (const std::size_t t : around[v]) {
            const auto& [a, b, c] = floor.triangles[t];
            if (area_from_above(floor.position[a], floor.position[b], floor.position[c]) <
                least_area[t]) {
                floor.position[v] = before;
                break;
            }
        }
    }
}

}  // namespace

void snap_to_contact(const Field& solid, double gap, TriangleMesh& floor) {
    std::vector<double> value(floor.position.size());
    for (std::size_t v = 0; v < value.size(); ++v) {
        value[v] = solid(floor.position[v]) - gap;
    }
    std::vector<double> nearest(value.size(), std::numeric_limits<double>::infinity());
    std::vector<glm::dvec3> target = floor.position;
    for (const auto& triangle : floor.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t a = triangle[k], b = triangle[(k + 1) % 3];
            if ((value[a] < 0) == (value[b] < 0)) {
                continue;
            }
            if (value[b] < 0) {
                std::swap(a, b);
            }
            const glm::dvec3 crossing =
                find_crossing(solid, floor.position[a], floor.position[b], gap);
            const double to_a = glm::distance(crossing, floor.position[a]);
            const double to_b = glm::distance(crossing, floor.position[b]);
            const std::size_t end = to_a < to_b ? a : b;
            if (std::min(to_a, to_b) < nearest[end]) {
                nearest[end] = std::min(to_a, to_b);
                target[end] = crossing;
            }
        }
    }
    move_vertices(nearest, target, floor);
}

}  // namespace opaline::bake
