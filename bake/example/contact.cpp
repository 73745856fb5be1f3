#include "bake/example/contact.h"

#include <algorithm>
#include <limits>
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
    floor.position = std::move(target);
}

}  // namespace opaline::bake
