#include "bake/scene/nested_media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "bake/scene/body_shells.h"
#include "bake/scene/horizon.h"
#include "bake/scene/triangle.h"

namespace opaline::bake {
namespace {

using Triangle = HorizonTree::Triangle;
using Node = HorizonTree::Node;

// Distance [m] of the nearest triangle, if it is below `most`; else `most`.
double distance_within(const HorizonTree& tree, glm::dvec3 point, double most) {
    walk_tree(
        tree,
        [&](const Node& node) { return glm::distance(node.centre, point) - node.radius < most; },
        [&](const Triangle& t) {
            most = std::min(most,
                            distance_to_triangle(glm::dvec3(t[0]) - point, glm::dvec3(t[1]) - point,
                                                 glm::dvec3(t[2]) - point));
        });
    return most;
}

// How often a line from the point leaves the surface, less how often it enters. `along` is unit.
int count_leaving(const HorizonTree& tree, glm::dvec3 point, glm::dvec3 along) {
    int leaving = 0;
    walk_tree(
        tree,
        [&](const Node& node) {
            const glm::dvec3 to = node.centre - point;
            const double ahead = glm::dot(to, along);
            return ahead > -node.radius &&
                   glm::dot(to, to) - ahead * ahead <= node.radius * node.radius * (1 + 1e-9);
        },
        [&](const Triangle& t) {
            const glm::dvec3 a = glm::dvec3(t[0]) - point, b = glm::dvec3(t[1]) - point,
                             c = glm::dvec3(t[2]) - point;
            const double u = glm::dot(along, glm::cross(b, c)),
                         v = glm::dot(along, glm::cross(c, a)),
                         w = glm::dot(along, glm::cross(a, b));
            const bool leaves = u > 0 && v > 0 && w > 0, enters = u < 0 && v < 0 && w < 0;
            // In front of the point: its volume with the triangle has the sign of the crossing.
            if ((leaves || enters) && (glm::dot(a, glm::cross(b, c)) > 0) == leaves) {
                leaving += leaves ? 1 : -1;
            }
        });
    return leaving;
}

bool is_inside(const HorizonTree& tree, glm::dvec3 point) {
    // Along no axis, edge or diagonal of common models.
    static const std::array<glm::dvec3, 3> kLines{
        glm::normalize(glm::dvec3(0.3617, 0.4803, 0.7991)),
        glm::normalize(glm::dvec3(-0.8011, 0.3589, -0.4794)),
        glm::normalize(glm::dvec3(0.4823, -0.7979, 0.3607))};
    int votes = 0;
    for (const glm::dvec3& line : kLines) {
        votes += count_leaving(tree, point, line) > 0 ? 1 : 0;
    }
    return votes >= 2;
}

std::array<Triangle, 4> quarter(const Triangle& t) {
    const glm::vec3 ab = 0.5f * (t[0] + t[1]), bc = 0.5f * (t[1] + t[2]), ca = 0.5f * (t[2] + t[0]);
    return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

// A bound on the work for a scene: about a second.
constexpr int kMostLooks = 1'000'000;

// Lowers `least` [m] to a lower bound of the distance between a triangle and the surface, at least
// half of it; to 0 where they are so near that they may meet. Keeps it where it is lower already.
void lower_to_gap(const HorizonTree& surface, const Triangle& triangle, int depth, int& looks,
                  double& least) {
    constexpr int kDeepest = 14;
    const glm::dvec3 middle =
        (glm::dvec3(triangle[0]) + glm::dvec3(triangle[1]) + glm::dvec3(triangle[2])) / 3.0;
    double radius = 0;
    for (const glm::vec3 corner : triangle) {
        radius = std::max(radius, glm::distance(middle, glm::dvec3(corner)));
    }
    if (--looks < 0) {
        least = 0;
        return;
    }
    const double reach = least + radius, distance = distance_within(surface, middle, reach);
    if (!(distance < reach)) return;
    if (distance - radius >= 0.5 * distance) {
        least = distance - radius;
    } else if (depth == kDeepest || !(radius > 0)) {
        least = 0;
    } else {
        for (const Triangle& part : quarter(triangle)) {
            if (least > 0) {
                lower_to_gap(surface, part, depth + 1, looks, least);
            }
        }
    }
}

// The surface of one material, for comparison with others.
struct Surface {
    BodyShells body;
    HorizonTree tree;
    std::vector<bool> is_buried;  // of each shell

    Triangle triangle(std::uint32_t i) const {
        const auto& point = body.triangle[body.order[i]].point;
        return {body.position[point[0]], body.position[point[1]], body.position[point[2]]};
    }
};

Surface make_surface(const formats::Scene& scene, std::uint32_t material) {
    Surface surface{make_body_shells(scene, material), make_horizon_tree(scene, material), {}};
    surface.is_buried.resize(surface.body.shell.size());
    return surface;
}

// Whether some of the shell's middles of triangles lie inside of `outer`.
bool reaches_into(const HorizonTree& outer, const Surface& of, const BodyShell& shell) {
    constexpr std::uint32_t kMostPoints = 64;
    const std::uint32_t step = std::max(1u, shell.count / kMostPoints);
    for (std::uint32_t i = 0; i < shell.count; i += step) {
        const Triangle t = of.triangle(shell.first + i);
        if (is_inside(outer, (glm::dvec3(t[0]) + glm::dvec3(t[1]) + glm::dvec3(t[2])) / 3.0)) {
            return true;
        }
    }
    return false;
}

bool reaches_into(const HorizonTree& outer, const Surface& of) {
    return std::ranges::any_of(
        of.body.shell, [&](const BodyShell& shell) { return reaches_into(outer, of, shell); });
}

// How deep [m] any of the inner surface lies inside the outer one, 0 where they meet; infinity:
// none does. Marks shells that lie inside altogether.
double find_depth(const Surface& outer, Surface& inner, int& looks) {
    double least = std::numeric_limits<double>::infinity();
    bool is_near = false, is_met = false;
    for (std::size_t s = 0; s < inner.body.shell.size(); ++s) {
        const BodyShell& shell = inner.body.shell[s];
        double gap = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = shell.first; i < shell.first + shell.count && gap > 0; ++i) {
            lower_to_gap(outer.tree, inner.triangle(i), 0, looks, gap);
        }
        const bool is_in = reaches_into(outer.tree, inner, shell);
        is_near = is_near || gap == 0;
        is_met = is_met || (gap == 0 && looks >= 0);
        if (is_in) {
            least = std::min(least, gap);
        }
        inner.is_buried[s] = inner.is_buried[s] || (is_in && gap > 0);
    }
    if (is_met) return 0;
    return is_near && least > 0 && reaches_into(inner.tree, outer) ? 0 : least;
}

// Light that goes into one body goes on into those that this one meets or holds.
void add_indirect(SceneFacts& facts) {
    bool changes = true;
    while (changes) {
        changes = false;
        for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
            std::vector<InnerMedium>& own = facts.material[m].inner;
            for (std::size_t i = 0; i < own.size(); ++i) {
                for (InnerMedium next : facts.material[own[i].material].inner) {
                    if (next.material == m ||
                        std::ranges::find(own, next.material, &InnerMedium::material) !=
                            own.end()) {
                        continue;
                    }
                    next.depth = own[i].depth;
                    own.push_back(std::move(next));
                    changes = true;
                }
            }
        }
    }
    for (MaterialFacts& own : facts.material) {
        std::ranges::sort(own.inner, {}, &InnerMedium::material);
    }
}

// Whether some of the surface lies inside of other bodies of the same material or against them:
// just outside of a triangle is then inside of one. Looks at some triangles, evenly spaced.
bool overlaps_itself(const Surface& surface, double size) {
    constexpr std::size_t kMostLooked = 4096;
    constexpr double kOutside = 1e-4;      // of the size: clear of rounding
    constexpr std::uint32_t kFewest = 20;  // one of so many is inside: fewer are folds
    const std::size_t step = 1 + surface.body.order.size() / kMostLooked;
    std::uint32_t looked = 0, inside = 0;
    for (std::size_t i = 0; i < surface.body.order.size(); i += step) {
        const BodyTriangle& t = surface.body.triangle[surface.body.order[i]];
        const auto corner = corners(surface.body, t);
        const glm::dvec3 area = area_vector(surface.body, t);
        const double length = glm::length(area);
        if (!(length > 0)) continue;
        ++looked;
        const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
        inside += is_inside(surface.tree, middle + kOutside * size / length * area) ? 1 : 0;
    }
    return inside * kFewest > looked;
}

bool boxes_meet(const MaterialFacts& a, const MaterialFacts& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) &&
           glm::all(glm::lessThanEqual(b.low, a.high));
}

// Enclosed by all bodies of a material [m^3], in the digits that do not depend on how they are cut
// into triangles. About one of their corners, so that an open body far
// from the origin is no larger for that.
float enclosed_volume(const formats::Scene& scene, std::uint32_t material) {
    std::optional<glm::dvec3> origin;
    double volume = 0;
    for (const formats::Primitive& p : scene.primitives) {
        if (p.material != material) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const glm::dvec3 a(p.position[p.index[i]]);
            const glm::dvec3 b(p.position[p.index[i + 1]]), c(p.position[p.index[i + 2]]);
            origin = origin.value_or(a);
            volume += glm::dot(a - *origin, glm::cross(b - *origin, c - *origin)) / 6;
        }
    }
    return static_cast<float>(std::abs(volume));
}

}  // namespace

void find_nested_media(const formats::Scene& scene, SceneFacts& facts) {
    const auto count = static_cast<std::uint32_t>(scene.materials.size());
    const auto is_body = [&](std::uint32_t m) {
        return scene.materials[m].medium && facts.material[m].triangles > 0;
    };
    int looks = kMostLooks;
    std::vector<Surface> surfaces(count);
    const auto surface_of = [&](std::uint32_t m) -> Surface& {
        if (surfaces[m].tree.node.empty()) {
            surfaces[m] = make_surface(scene, m);
        }
        return surfaces[m];
    };
    for (std::uint32_t outer = 0; outer < count; ++outer) {
        MaterialFacts& own = facts.material[outer];
        for (std::uint32_t inner = 0; inner < count; ++inner) {
            if (inner == outer || !is_body(outer) || !is_body(inner) ||
                !boxes_meet(own, facts.material[inner])) {
                continue;
            }
            const double depth = find_depth(surface_of(outer), surface_of(inner), looks);
            if (std::isfinite(depth)) {
                own.inner.push_back({inner, depth, *scene.materials[inner].medium});
            }
        }
    }
    constexpr std::uint32_t kMostTriangles = 200'000;  // of a material that is looked at so closely
    for (std::uint32_t m = 0; m < count; ++m) {
        MaterialFacts& own = facts.material[m];
        if (!is_body(m) || own.triangles > kMostTriangles) continue;
        const Surface& surface = surface_of(m);
        own.overlaps =
            surface.body.shell.size() > 1 &&
            overlaps_itself(surface, static_cast<double>(glm::distance(own.low, own.high)));
    }
    add_indirect(facts);
    for (std::uint32_t m = 0; m < count; ++m) {
        MaterialFacts& own = facts.material[m];
        const std::vector<bool>& is_buried = surfaces[m].is_buried;
        own.is_buried = !is_buried.empty() &&
                        std::ranges::all_of(is_buried, [](bool buried) { return buried; });
        own.is_grey =
            own.is_grey && std::ranges::all_of(own.inner, [](const InnerMedium& inner) {
                const auto same = [](const formats::Rgb& c) { return c.r == c.g && c.g == c.b; };
                return same(inner.medium.sigma_s) && same(inner.medium.sigma_a);
            });
    }
}

std::vector<std::uint32_t> order_media(const formats::Scene& scene) {
    std::vector<float> volume(scene.materials.size());
    std::vector<std::uint32_t> order;
    for (auto m = static_cast<std::uint32_t>(scene.materials.size()); m-- > 0;) {
        if (!scene.materials[m].medium) continue;
        volume[m] = enclosed_volume(scene, m);
        order.push_back(m);
    }
    std::ranges::stable_sort(
        order, [&](std::uint32_t a, std::uint32_t b) { return volume[a] > volume[b]; });
    return order;
}

}  // namespace opaline::bake
