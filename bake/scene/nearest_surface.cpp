#include "bake/scene/nearest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "bake/base/parallel_indices.h"

namespace opaline::bake {
namespace {

float squared(glm::vec3 v) {
    return glm::dot(v, v);
}

// Of a box, from a point: 0 inside.
float squared_distance(glm::vec3 point, glm::vec3 low, glm::vec3 high) {
    return squared(glm::max(glm::max(low - point, point - high), glm::vec3(0)));
}

struct Weights {
    float u = 0, v = 0;
};

// The nearest point of a triangle: below the point, if that lies inside, else on an edge.
Weights nearest_weights(const glm::vec3 (&corner)[3], glm::vec3 point) {
    const glm::vec3 a = corner[1] - corner[0], b = corner[2] - corner[0], p = point - corner[0];
    const float aa = squared(a), bb = squared(b), ab = glm::dot(a, b);
    const float pa = glm::dot(p, a), pb = glm::dot(p, b);
    const float area = aa * bb - ab * ab;
    if (area > 0) {
        const float u = (bb * pa - ab * pb) / area, v = (aa * pb - ab * pa) / area;
        if (u >= 0 && v >= 0 && u + v <= 1) {
            return {u, v};
        }
    }
    const auto along = [](float part, float whole) {
        return whole > 0 ? std::clamp(part / whole, 0.0f, 1.0f) : 0.0f;
    };
    const glm::vec3 c = b - a;
    const float on_a = along(pa, aa), on_b = along(pb, bb),
                on_c = along(glm::dot(p - a, c), squared(c));
    const Weights edges[3] = {{on_a, 0}, {0, on_b}, {1 - on_c, on_c}};
    return *std::ranges::min_element(
        edges, {}, [&](const Weights& w) { return squared(w.u * a + w.v * b - p); });
}

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
        if (places[from].primitive == formats::kNone) return;
        const float distance = glm::distance(nodes.position(at.x, at.y, at.z), points[from]);
        if (places[to].primitive == formats::kNone || distance < places[to].distance) {
            places[to] = places[from];
            places[to].distance = distance;
            points[to] = points[from];
        }
    }
};

}  // namespace

struct NearestSurface::Search {
    glm::vec3 point;
    float best;  // squared distance [m^2]
    Place found;
};

NearestSurface::NearestSurface(const formats::Scene& scene, std::uint32_t material) {
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        if (primitive.material != material) continue;
        for (std::uint32_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            const auto corner = [&](std::uint32_t k) {
                return primitive.position[primitive.index[i + k]];
            };
            triangles_.push_back({{corner(0), corner(1), corner(2)}, p, i});
        }
    }
    if (!triangles_.empty()) {
        build(0, static_cast<std::uint32_t>(triangles_.size()));
    }
}

std::uint32_t NearestSurface::build(std::uint32_t first, std::uint32_t last) {
    constexpr std::uint32_t kInLeaf = 4;
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    node.low = node.high = triangles_[first].corner[0];
    for (std::uint32_t i = first; i < last; ++i) {
        for (const glm::vec3 x : triangles_[i].corner) {
            node.low = glm::min(node.low, x);
            node.high = glm::max(node.high, x);
        }
    }
    nodes_.push_back(node);
    if (last - first <= kInLeaf) {
        nodes_[number].first = first;
        nodes_[number].count = last - first;
        return number;
    }
    const glm::vec3 size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto key = [axis](const Triangle& t) {
        const float middle = t.corner[0][axis] + t.corner[1][axis] + t.corner[2][axis];
        return std::tuple(middle, t.primitive, t.first_index);
    };
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + half,
                     triangles_.begin() + last,
                     [&](const Triangle& a, const Triangle& b) { return key(a) < key(b); });
    build(first, half);
    const std::uint32_t second = build(half, last);
    nodes_[number].second = second;
    return number;
}

void NearestSurface::visit(std::uint32_t number, Search& search) const {
    const Node& node = nodes_[number];
    if (node.count == 0) {
        const auto distance = [&](std::uint32_t child) {
            return squared_distance(search.point, nodes_[child].low, nodes_[child].high);
        };
        const float to_first = distance(number + 1), to_second = distance(node.second);
        const bool swaps = to_second < to_first;
        if (std::min(to_first, to_second) <= search.best) {
            visit(swaps ? node.second : number + 1, search);
        }
        if (std::max(to_first, to_second) <= search.best) {
            visit(swaps ? number + 1 : node.second, search);
        }
        return;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Triangle& t = triangles_[i];
        const Weights w = nearest_weights(t.corner, search.point);
        const glm::vec3 at =
            t.corner[0] + w.u * (t.corner[1] - t.corner[0]) + w.v * (t.corner[2] - t.corner[0]);
        const float distance = squared(at - search.point);
        const bool is_first = std::tuple(t.primitive, t.first_index) <
                              std::tuple(search.found.primitive, search.found.first_index);
        if (distance < search.best || (distance == search.best && is_first)) {
            search.best = distance;
            search.found = {t.primitive, t.first_index, w.u, w.v, 0};
        }
    }
}

NearestSurface::Place NearestSurface::find(glm::vec3 point, float reach) const {
    Search search{point, reach * reach, {}};
    if (!nodes_.empty()) {
        visit(0, search);
    }
    search.found.distance = std::sqrt(search.best);
    return search.found;
}

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
