#include "bake/scene/horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "bake/scene/triangle.h"

namespace opaline::bake {
namespace {

using Triangle = HorizonTree::Triangle;
using Node = HorizonTree::Node;

glm::dvec3 area_vector(const Triangle& t) {
    const glm::dvec3 a = t[0];
    return glm::cross(glm::dvec3(t[1]) - a, glm::dvec3(t[2]) - a);
}

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

    void add(glm::vec3 x) {
        low = glm::min(low, x);
        high = glm::max(high, x);
    }
    glm::length_t widest() const {
        const glm::vec3 size = high - low;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }
};

Node enclose(const std::vector<Triangle>& triangles, std::uint32_t first, std::uint32_t count) {
    Node node;
    node.first = first;
    node.count = count;
    Box box;
    glm::dvec3 axis(0);
    for (std::uint32_t i = first; i < first + count; ++i) {
        axis += area_vector(triangles[i]);
        for (const glm::vec3 x : triangles[i]) {
            box.add(x);
        }
    }
    node.centre = 0.5 * (glm::dvec3(box.low) + glm::dvec3(box.high));
    const double length = glm::length(axis);
    node.axis = length > 0 ? axis / length : glm::dvec3(0, 0, 1);
    node.low = std::numeric_limits<double>::infinity();
    node.high = -node.low;
    double squared = 0;
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (const glm::vec3 x : triangles[i]) {
            const glm::dvec3 from = glm::dvec3(x) - node.centre;
            const double along = glm::dot(from, node.axis);
            node.low = std::min(node.low, along);
            node.high = std::max(node.high, along);
            squared = std::max(squared, glm::dot(from, from));
        }
    }
    node.radius = std::sqrt(squared);
    return node;
}

glm::vec3 unit_normal(const Triangle& t) {
    return glm::vec3(glm::normalize(area_vector(t)));
}

// Partitions the triangles and returns the size of the first child. Triangles with different facing
// are separated first, which makes the slabs thin; then by position.
std::uint32_t part(std::span<Triangle> triangles) {
    constexpr float kAlike = 0.5f;
    const auto middle_of = [](const Triangle& t) { return t[0] + t[1] + t[2]; };
    Box normals, places;
    for (const Triangle& t : triangles) {
        normals.add(unit_normal(t));
        places.add(middle_of(t));
    }
    const glm::length_t facing = normals.widest(), axis = places.widest();
    if (normals.high[facing] - normals.low[facing] > kAlike) {
        const float between = 0.5f * (normals.low[facing] + normals.high[facing]);
        const auto second =
            std::partition(triangles.begin(), triangles.end(),
                           [&](const Triangle& t) { return unit_normal(t)[facing] < between; });
        return static_cast<std::uint32_t>(second - triangles.begin());
    }
    const auto half = static_cast<std::ptrdiff_t>(triangles.size() / 2);
    std::nth_element(triangles.begin(), triangles.begin() + half, triangles.end(),
                     [&](const Triangle& a, const Triangle& b) {
                         return middle_of(a)[axis] < middle_of(b)[axis];
                     });
    return static_cast<std::uint32_t>(half);
}

void build(HorizonTree& tree, std::uint32_t first, std::uint32_t count) {
    constexpr std::uint32_t kLeaf = 4;
    const auto self = static_cast<std::uint32_t>(tree.node.size());
    tree.node.push_back(enclose(tree.triangle, first, count));
    if (count <= kLeaf) return;
    const std::uint32_t left = part(std::span(tree.triangle).subspan(first, count));
    build(tree, first, left);
    tree.node[self].right = static_cast<std::uint32_t>(tree.node.size());
    build(tree, first + left, count - left);
}

// True if the whole node lies below the elevation found so far.
bool is_lower(const Node& node, glm::dvec3 point, glm::dvec3 normal, const HorizonSearch& found) {
    const glm::dvec3 to_centre = node.centre - point;
    const double along = glm::dot(normal, node.axis);
    const double across = std::sqrt(std::max(0.0, 1 - along * along));
    const double above = std::max(along * node.low, along * node.high) + across * node.radius;
    const double height = glm::dot(normal, to_centre) + std::min(above, node.radius);
    return height <= std::max(found.flat, found.sine * (glm::length(to_centre) - node.radius));
}

double sine_of(const Triangle& triangle, glm::vec3 point, glm::dvec3 normal, double flat) {
    std::array<glm::dvec3, 3> to;
    for (std::size_t k = 0; k < 3; ++k) {
        to[k] = glm::dvec3(triangle[k]) - glm::dvec3(point);
    }
    const double height =
        std::max({glm::dot(normal, to[0]), glm::dot(normal, to[1]), glm::dot(normal, to[2])});
    if (!(height > flat)) return 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (triangle[k] == point) {
            // A direction between the two is b u + c v, its height at most (b + c) times the larger
            // sine, its length at least (b + c) cos(angle / 2).
            const glm::dvec3 u = glm::normalize(to[(k + 1) % 3]),
                             v = glm::normalize(to[(k + 2) % 3]);
            const double larger = std::max(glm::dot(normal, u), glm::dot(normal, v));
            return std::min(1.0, larger / (0.5 * glm::length(u + v)));
        }
    }
    const double distance = distance_to_triangle(to[0], to[1], to[2]);
    return height < distance ? height / distance : 1.0;
}

}  // namespace

HorizonTree make_horizon_tree(std::vector<Triangle> triangles) {
    HorizonTree tree;
    tree.triangle = std::move(triangles);
    std::erase_if(tree.triangle,
                  [](const Triangle& t) { return !(glm::length(area_vector(t)) > 0); });
    if (!tree.triangle.empty()) {
        tree.node.reserve(tree.triangle.size());
        build(tree, 0, static_cast<std::uint32_t>(tree.triangle.size()));
    }
    return tree;
}

HorizonTree make_horizon_tree(const formats::Scene& scene, std::optional<std::uint32_t> material) {
    std::vector<Triangle> triangles;
    for (const formats::Primitive& p : scene.primitives) {
        if (p.material != material.value_or(p.material)) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            triangles.push_back(
                {p.position[p.index[i]], p.position[p.index[i + 1]], p.position[p.index[i + 2]]});
        }
    }
    return make_horizon_tree(std::move(triangles));
}

double farthest_along(const HorizonTree& tree, glm::dvec3 direction) {
    double farthest = -std::numeric_limits<double>::infinity();
    for (const Triangle& t : tree.triangle) {
        for (const glm::vec3 x : t) {
            farthest = std::max(farthest, glm::dot(direction, glm::dvec3(x)));
        }
    }
    return farthest;
}

void look_over_horizon(const HorizonTree& tree, glm::vec3 point, glm::dvec3 normal,
                       HorizonSearch& search) {
    walk_tree(
        tree,
        [&](const Node& node) {
            if (search.is_over()) return false;
            --search.nodes_left;
            return !is_lower(node, glm::dvec3(point), normal, search);
        },
        [&](const Triangle& t) {
            search.sine = std::max(search.sine, sine_of(t, point, normal, search.flat));
        });
}

}  // namespace opaline::bake
