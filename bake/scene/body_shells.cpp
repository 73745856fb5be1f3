#include "bake/scene/body_shells.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>
#include <span>
#include <tuple>

#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// One edge of a triangle, from its point of the lower number to `high`, or in the opposite
// direction.
struct Side {
    std::uint32_t high, triangle;
    bool upward;
};

// Another triangle that shares an edge with no third.
struct Neighbour {
    std::uint32_t triangle;
    bool same_way;  // they already face the same way
};

// Of one triangle: one at each edge at most.
struct Neighbours {
    std::array<Neighbour, 3> at;
    std::uint32_t count = 0;

    const Neighbour* begin() const { return at.data(); }
    const Neighbour* end() const { return at.data() + count; }
};

// Calls visit(low, side) for all edges of all triangles.
template <class Visit>
void for_each_side(const BodyShells& body, Visit&& visit) {
    for (std::uint32_t t = 0; t < body.triangle.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = body.triangle[t].point[k];
            const std::uint32_t b = body.triangle[t].point[(k + 1) % 3];
            visit(std::min(a, b), Side{std::max(a, b), t, a < b});
        }
    }
}

// Sides are sorted by the lower point by counting, in a time that is linear in their number.
std::vector<Neighbours> find_neighbours(BodyShells& body) {
    std::vector<std::size_t> first(body.position.size() + 2, 0);  // side of each point
    for_each_side(body, [&](std::uint32_t low, const Side&) { ++first[low + 2]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Side> sides(3 * body.triangle.size());
    for_each_side(body,
                  [&](std::uint32_t low, const Side& side) { sides[first[low + 1]++] = side; });
    std::vector<Neighbours> neighbours(body.triangle.size());
    const auto join = [&](const Side& of, const Side& to) {
        Neighbours& own = neighbours[of.triangle];
        own.at[own.count++] = {to.triangle, of.upward != to.upward};
    };
    for (std::size_t low = 0; low < body.position.size(); ++low) {
        const std::span<Side> own =
            std::span(sides).subspan(first[low], first[low + 1] - first[low]);
        std::ranges::sort(own, [](const Side& a, const Side& b) {
            return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
        });
        for (std::size_t i = 0, end = 0; i < own.size(); i = end) {
            while (end < own.size() && own[end].high == own[i].high) {
                ++end;
            }
            if ((end - i) % 2 != 0) {
                ++body.open_edges;
                for (std::size_t k = i; k < end; ++k) {
                    body.triangle[own[k].triangle].is_at_end = true;
                }
            }
            if (end - i == 2) {
                join(own[i], own[i + 1]);
                join(own[i + 1], own[i]);
            }
        }
    }
    return neighbours;
}

constexpr double kSharp = 0.7;  // sine of 45 degrees

// At the common edge of two triangles.
struct Fold {
    double sine = 0;    // of the angle by which one rises above the plane of the other, +-1 beyond
                        // a right angle; negative: it falls below that plane
    double length = 0;  // [m] of the edge
};

Fold find_fold(const BodyShells& body, const BodyTriangle& t, const BodyTriangle& other) {
    const std::array<glm::dvec3, 3> corner = corners(body, t);
    const std::array<std::uint32_t, 3>& p = t.point;
    const std::array<std::uint32_t, 3> point =
        t.turned ? std::array{p[0], p[2], p[1]} : std::array{p[0], p[1], p[2]};
    const auto is_corner = [](const BodyTriangle& of, std::uint32_t at) {
        return std::find(of.point.begin(), of.point.end(), at) != of.point.end();
    };
    const auto apex = std::find_if(other.point.begin(), other.point.end(),
                                   [&](std::uint32_t at) { return !is_corner(t, at); });
    const double area = 2 * glm::length(area_vector(body, t));
    if (apex == other.point.end() || !(area > 0)) return {};
    const glm::dvec3 normal = 2.0 / area * area_vector(body, t);
    for (std::size_t k = 0; k < 3; ++k) {
        if (is_corner(other, point[k]) && is_corner(other, point[(k + 1) % 3])) {
            const glm::dvec3 edge = glm::normalize(corner[(k + 1) % 3] - corner[k]);
            const glm::dvec3 rise = glm::dvec3(body.position[*apex]) - corner[k];
            const double out = glm::dot(glm::cross(edge, normal), rise);
            const double up = glm::dot(normal, rise);
            // A height below the rounding error of the coordinates counts as flat.
            constexpr double kRoundings = 4 * 0x1p-23;
            const glm::dvec3 size = glm::abs(corner[k]);
            if (std::abs(up) <= kRoundings * std::max({size.x, size.y, size.z})) {
                return {};
            }
            return {out > 0 ? up / std::hypot(up, out) : std::copysign(1.0, up),
                    glm::distance(corner[k], corner[(k + 1) % 3])};
        }
    }
    return {};
}

// Points by their position: numbers in a table that is half empty, in which a search goes on from
// slot to slot.
class Places {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    explicit Places(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), kNone) {}
    std::uint32_t find_or_add(glm::vec3 at, std::vector<glm::vec3>& position) {
        for (std::size_t slot = PositionHash{}(at);; ++slot) {
            std::uint32_t& number = slots_[slot & (slots_.size() - 1)];
            if (number == kNone) {
                number = static_cast<std::uint32_t>(position.size());
                position.push_back(at);
            }
            if (position[number] == at) return number;
        }
    }

  private:
    std::vector<std::uint32_t> slots_;
};

// Cuts the body into shells and turns each to the direction of its larger part.
void cut_into_shells(BodyShells& body) {
    const auto neighbours = find_neighbours(body);
    std::vector<bool> seen(body.triangle.size(), false);
    for (std::uint32_t seed = 0; seed < body.triangle.size(); ++seed) {
        if (seen[seed]) continue;
        BodyShell shell;
        shell.first = static_cast<std::uint32_t>(body.order.size());
        seen[seed] = true;
        body.order.push_back(seed);
        double kept = 0, turned = 0;
        for (std::size_t at = shell.first; at < body.order.size(); ++at) {
            BodyTriangle& t = body.triangle[body.order[at]];
            (t.turned ? turned : kept) += glm::length(area_vector(body, t));
            shell.is_open = shell.is_open || t.is_at_end;
            for (const Neighbour& n : neighbours[body.order[at]]) {
                if (!seen[n.triangle]) {
                    seen[n.triangle] = true;
                    body.triangle[n.triangle].turned = t.turned == n.same_way;
                    body.order.push_back(n.triangle);
                }
            }
        }
        shell.count = static_cast<std::uint32_t>(body.order.size()) - shell.first;
        shell.area = kept + turned;
        for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
            BodyTriangle& t = body.triangle[body.order[i]];
            t.turned = t.turned != (turned > kept);
            for (const std::uint32_t p : t.point) {
                shell.low = glm::min(shell.low, glm::dvec3(body.position[p]));
                shell.high = glm::max(shell.high, glm::dvec3(body.position[p]));
            }
        }
        const glm::dvec3 centre = 0.5 * (shell.low + shell.high);
        for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
            const BodyTriangle& t = body.triangle[body.order[i]];
            shell.volume += glm::dot(corners(body, t)[0] - centre, area_vector(body, t)) / 3;
            for (const Neighbour& n : neighbours[body.order[i]]) {
                const Fold fold = find_fold(body, t, body.triangle[n.triangle]);
                shell.valley = std::max(shell.valley, fold.sine);
                shell.ridge = std::max(shell.ridge, -fold.sine);
                if (-fold.sine > kSharp) shell.sharp += 0.5 * fold.length;
            }
        }
        body.shell.push_back(shell);
    }
}

std::vector<std::uint32_t> primitives_of(const Scene& scene, const std::vector<bool>& chosen) {
    std::vector<std::uint32_t> primitives;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (chosen[scene.primitives[p].material]) primitives.push_back(p);
    }
    return primitives;
}

std::vector<std::uint32_t> primitives_of(const Scene& scene, std::uint32_t material) {
    std::vector<bool> chosen(scene.materials.size(), false);
    chosen[material] = true;
    return primitives_of(scene, chosen);
}

}  // namespace

std::array<glm::dvec3, 3> corners(const BodyShells& body, const BodyTriangle& t) {
    const std::size_t second = t.turned ? 2 : 1;
    return {body.position[t.point[0]], body.position[t.point[second]],
            body.position[t.point[3 - second]]};
}

glm::dvec3 area_vector(const BodyShells& body, const BodyTriangle& t) {
    const auto [a, b, c] = corners(body, t);
    return 0.5 * glm::cross(b - a, c - a);
}

BodyShells weld_triangles(const Scene& scene, std::span<const std::uint32_t> primitives) {
    BodyShells body;
    std::size_t vertices = 0;
    for (const std::uint32_t p : primitives) {
        vertices += scene.primitives[p].position.size();
    }
    Places places(vertices);
    std::vector<std::uint32_t> point;  // of each vertex of a primitive
    for (const std::uint32_t p : primitives) {
        const Primitive& primitive = scene.primitives[p];
        point.assign(primitive.position.size(), Places::kNone);
        for (std::uint32_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            BodyTriangle t{{}, p, i};
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = primitive.index[i + k];
                if (point[vertex] == Places::kNone) {
                    point[vertex] =
                        places.find_or_add(weld_key(primitive.position[vertex]), body.position);
                }
                t.point[k] = point[vertex];
            }
            // Skip triangles with two equal corners: their neighbours' edges coincide and join
            // directly.
            if (t.point[0] != t.point[1] && t.point[1] != t.point[2] && t.point[2] != t.point[0]) {
                body.triangle.push_back(t);
            }
        }
    }
    return body;
}

BodyShells make_body_shells(const Scene& scene, std::uint32_t material) {
    return make_body_shells(scene, primitives_of(scene, material));
}

BodyShells make_body_shells(const Scene& scene, const std::vector<bool>& chosen) {
    return make_body_shells(scene, primitives_of(scene, chosen));
}

BodyShells make_body_shells(const Scene& scene, std::span<const std::uint32_t> primitives) {
    BodyShells body = weld_triangles(scene, primitives);
    cut_into_shells(body);
    return body;
}

}  // namespace opaline::bake
