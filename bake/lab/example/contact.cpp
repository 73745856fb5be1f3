#include "bake/lab/example/solid_mesh.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace opaline::bake {
namespace {

// The point between a and b at which the value is 0; exactly one of them has a value below 0.
glm::dvec3 find_crossing(const ScalarField& solid, double gap, const TriangleMesh& floor,
                         const std::vector<double>& value, std::uint32_t a, std::uint32_t b) {
    glm::dvec3 inside = floor.position[std::min(a, b)], outside = floor.position[std::max(a, b)];
    if (value[std::max(a, b)] < 0) {
        std::swap(inside, outside);
    }
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

// Makes the moves, short ones first. Skips moves that would flatten or flip a triangle. Vertices
// moved are on the curve: their value becomes 0.
void move_vertices(const std::vector<double>& distance, const std::vector<glm::dvec3>& target,
                   std::vector<double>& value, TriangleMesh& floor) {
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
    std::vector<std::size_t> order;
    for (std::size_t v = 0; v < distance.size(); ++v) {
        if (distance[v] < std::numeric_limits<double>::infinity()) {
            order.push_back(v);
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance[a] < distance[b]; });
    for (const std::size_t v : order) {
        const glm::dvec3 before = std::exchange(floor.position[v], target[v]);
        const bool is_sound = std::all_of(around[v].begin(), around[v].end(), [&](std::size_t t) {
            const auto& [a, b, c] = floor.triangles[t];
            return area_from_above(floor.position[a], floor.position[b], floor.position[c]) >=
                   least_area[t];
        });
        if (is_sound) {
            value[v] = 0;
        } else {
            floor.position[v] = before;
        }
    }
}

bool crosses(double a, double b) {
    return (a < 0 && b > 0) || (a > 0 && b < 0);
}

// Moves the ends of crossing edges that are within a quarter of the edge of the curve.
void snap(const ScalarField& solid, double gap, std::vector<double>& value, TriangleMesh& floor) {
    constexpr double kReach = 0.25;  // of an edge
    std::vector<double> nearest(value.size(), std::numeric_limits<double>::infinity());
    std::vector<glm::dvec3> target = floor.position;
    for (const auto& triangle : floor.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
            if (!crosses(value[a], value[b])) continue;
            const glm::dvec3 crossing = find_crossing(solid, gap, floor, value, a, b);
            const double reach = kReach * glm::distance(floor.position[a], floor.position[b]);
            for (const std::uint32_t end : {a, b}) {
                const double distance = glm::distance(crossing, floor.position[end]);
                if (distance < std::min(reach, nearest[end])) {
                    nearest[end] = distance;
                    target[end] = crossing;
                }
            }
        }
    }
    move_vertices(nearest, target, value, floor);
}

// Splits the triangles that still lie on both sides, at the points where their edges cross.
void split(const ScalarField& solid, double gap, std::vector<double>& value, TriangleMesh& floor) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
    const auto crossing_of = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] =
            made.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(floor.position.size()));
        if (is_new) {
            floor.position.push_back(find_crossing(solid, gap, floor, value, a, b));
            floor.normal.push_back(floor.normal[a]);
            value.push_back(0);
        }
        return entry->second;
    };
    std::vector<Triangle> pieces;
    for (const Triangle& whole : floor.triangles) {
        // Turned so that the edges a-b and c-a are those that cross, or a-b alone.
        auto [a, b, c] = whole;
        for (int turn = 0; turn < 2; ++turn) {
            const bool crosses_ab = crosses(value[a], value[b]);
            if (crosses_ab && !crosses(value[b], value[c])) break;
            std::tie(a, b, c) = std::make_tuple(b, c, a);
        }
        if (!crosses(value[a], value[b])) {
            pieces.push_back(whole);
            continue;
        }
        const std::uint32_t ab = crossing_of(a, b);
        if (!crosses(value[c], value[a])) {
            pieces.insert(pieces.end(), {{a, ab, c}, {ab, b, c}});
            continue;
        }
        const std::uint32_t ca = crossing_of(c, a);
        pieces.push_back({a, ab, ca});
        // Split the remaining quadrangle along its shorter diagonal.
        if (glm::distance(floor.position[ab], floor.position[c]) <
            glm::distance(floor.position[b], floor.position[ca])) {
            pieces.insert(pieces.end(), {{ab, b, c}, {ab, c, ca}});
        } else {
            pieces.insert(pieces.end(), {{ab, b, ca}, {b, c, ca}});
        }
    }
    floor.triangles = std::move(pieces);
}

}  // namespace

void cut_at_contact(const ScalarField& solid, double gap, TriangleMesh& floor) {
    std::vector<double> value(floor.position.size());
    for (std::size_t v = 0; v < value.size(); ++v) {
        value[v] = solid(floor.position[v]) - gap;
    }
    snap(solid, gap, value, floor);
    split(solid, gap, value, floor);
}

}  // namespace opaline::bake
