#include "bake/scene/inspect_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/scene/body_shells.h"
#include "bake/scene/coverage.h"
#include "bake/scene/horizon.h"
#include "bake/scene/nested_media.h"
#include "bake/scene/parts_apart.h"
#include "bake/scene/scene_facts.h"
#include "bake/scene/sent_share.h"
#include "bake/scene/shared_rows.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;
using Triangles = std::vector<HorizonTree::Triangle>;

// Limit on visited nodes for the whole scene: some tenths of a second.
constexpr std::int64_t kMostNodes = 40'000'000;

// The searches of the trees, with their shared state: remaining work, and the rounding error of
// heights.
struct Searches {
    double flat = 0;
    std::int64_t nodes_left = kMostNodes;

    HorizonSearch start() const { return {kLeastElevation, flat, kMostElevation, nodes_left}; }
};

// True if the shell folds inward, as most non-convex shells do; inverted for a shell that faces
// inward.
bool folds_inward(const BodyShell& shell) {
    return (shell.volume < 0 ? shell.ridge : shell.valley) > kMostElevation;
}

// Size, colours and the tilt of shading normals against their facets. Volumes are those of cones
// with their tip at `origin`, a point of the material's surface, so that holes take little away.
void inspect_primitive(const Primitive& primitive, glm::dvec3 origin, MaterialFacts& facts) {
    facts.triangles += static_cast<double>(primitive.index.size()) / 3;
    for (const glm::vec3 x : primitive.position) {
        facts.low = glm::min(facts.low, x);
        facts.high = glm::max(facts.high, x);
    }
    for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3) {
        const std::uint32_t* const v = &primitive.index[i];
        const glm::dvec3 a = primitive.position[v[0]], b = primitive.position[v[1]],
                         c = primitive.position[v[2]];
        facts.mean_edge += glm::length(b - a) + glm::length(c - b) + glm::length(a - c);
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const double length = glm::length(n);
        facts.area += 0.5 * length;
        facts.volume += glm::dot(a - origin, glm::cross(b - origin, c - origin)) / 6;
        for (std::size_t k = 0; k < 3 && length > 0; ++k) {
            const double cosine = glm::dot(n, glm::dvec3(primitive.normal[v[k]])) / length;
            facts.horizon.behind_facets = std::max(facts.horizon.behind_facets, 0.5 * (1 - cosine));
        }
    }
}

bool is_body(const formats::Material& material) {
    return material.medium && !material.sheet;
}

void find_things_inside(const Scene& scene, SceneFacts& facts) {
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        MaterialFacts& own = facts.material[m];
        for (std::uint32_t o = 0; o < facts.material.size() && is_body(scene.materials[m]); ++o) {
            const MaterialFacts& other = facts.material[o];
            own.may_hold_things =
                own.may_hold_things ||
                (!is_body(scene.materials[o]) && glm::all(glm::lessThan(own.low, other.high)) &&
                 glm::all(glm::lessThan(other.low, own.high)));
        }
    }
}

double find_elevation(const Scene& scene, const HorizonTree& tree, std::uint32_t material,
                      Searches& searches) {
    HorizonSearch search = searches.start();
    // Neighbours on a flat face share a normal, so one search decides for all of them; it counts as
    // work.
    glm::vec3 last(0);
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    double farthest = kUnknown;
    for (const Primitive& p : scene.primitives) {
        for (std::size_t v = 0; p.material == material && v < p.position.size(); ++v) {
            const glm::dvec3 normal = p.normal[v];
            const bool is_same = p.normal[v] == std::exchange(last, p.normal[v]);
            if (!is_same) {
                farthest = kUnknown;
            } else if (farthest == kUnknown && !search.is_over()) {
                farthest = farthest_along(tree, normal);
                search.nodes_left -= static_cast<std::int64_t>(tree.triangle.size() / 4);
            }
            const bool is_flat =
                farthest - glm::dot(normal, glm::dvec3(p.position[v])) <= search.flat;
            if (last != glm::vec3(0) && !is_flat) {
                look_over_horizon(tree, p.position[v], normal, search);
            }
        }
    }
    searches.nodes_left = search.nodes_left;
    return search.is_over() ? 1 : search.sine;
}

void inspect_colors(const Scene& scene, std::uint32_t material, MaterialFacts& facts) {
    const ColorRange color = find_color_range(scene, material);
    facts.brightest_vertex = color.brightest_vertex;
    facts.color_contrast = color.contrast;
    facts.is_grey = has_grey_numbers(scene, material);
    if (const auto& medium = scene.materials[material].medium) {
        facts.varies = medium->variation.has_value();
        facts.mirrors = medium->eta != 1;
    }
}

void inspect_surroundings(const Scene& scene, SceneFacts& facts) {
    Surroundings all{0, true};
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        MaterialFacts& own = facts.material[m];
        if (!(own.receivers > 0)) continue;
        const SentShare sent = find_sent_share(scene, m, own.brightest_vertex);
        own.brightest = sent.diffuse;
        own.textures = find_texture_facts(scene, m, sent.all);
        all.area += own.area;
        all.brightest = std::max(all.brightest, sent.all);
        all.is_grey = all.is_grey && sent.is_grey;
    }
    for (MaterialFacts& own : facts.material) {
        own.surroundings = all;
    }
}

// Where the scene reaches farthest along each axis, both ways.
using Ends = std::array<glm::vec3, 6>;

Ends find_ends(const Scene& scene) {
    Ends ends;
    ends.fill(glm::vec3(0));
    std::array<float, 6> farthest;
    farthest.fill(-std::numeric_limits<float>::infinity());
    for (const Primitive& p : scene.primitives) {
        for (const std::uint32_t v : p.index) {
            const glm::vec3 x = p.position[v];
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                for (const bool back : {false, true}) {
                    const auto end = 2 * static_cast<std::size_t>(axis) + (back ? 1 : 0);
                    const float along = back ? -x[axis] : x[axis];
                    if (along > farthest[end]) {
                        farthest[end] = along;
                        ends[end] = x;
                    }
                }
            }
        }
    }
    return ends;
}

// Whether some receiver sees another corner of its triangle, or one of the scene's ends, above its
// horizon. Of most materials that are not open this is found at once, without any topology.
bool sees_at_a_glance(const Scene& scene, std::uint32_t material, const Ends& ends, double flat) {
    const auto sees = [&](const Primitive& p, std::uint32_t v, glm::vec3 point) {
        const glm::dvec3 to = glm::dvec3(point) - glm::dvec3(p.position[v]);
        const double height = glm::dot(glm::dvec3(p.normal[v]), to);
        return height > flat &&
               height * height > kMostElevation * kMostElevation * glm::dot(to, to);
    };
    for (const Primitive& p : scene.primitives) {
        if (p.material != material) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            const std::uint32_t* const v = &p.index[i];
            const glm::dvec3 a = p.position[v[0]], b = p.position[v[1]], c = p.position[v[2]];
            if (glm::cross(b - a, c - a) == glm::dvec3(0)) continue;  // no ray hits it
            for (std::size_t k = 0; k < 3; ++k) {
                if (sees(p, v[k], p.position[v[(k + 1) % 3]]) ||
                    sees(p, v[k], p.position[v[(k + 2) % 3]])) {
                    return true;
                }
            }
        }
        for (std::uint32_t v = 0; v < p.position.size(); ++v) {
            if (std::ranges::any_of(ends, [&](glm::vec3 end) { return sees(p, v, end); })) {
                return true;
            }
        }
    }
    return false;
}

// Of primitives of one material that are apart from its others.
struct PartShape {
    std::uint64_t open_edges = 0;
    double hole_area = 0;  ///< [m^2] a bound
    double sharp = 0;      ///< [m] of BodyShell
    bool folds = false;    ///< inward
};

PartShape inspect_part(const Scene& scene, std::span<const std::uint32_t> primitives) {
    const BodyShells body = make_body_shells(scene, primitives);
    double sharp = 0;
    for (const BodyShell& shell : body.shell) {
        sharp += shell.sharp;
    }
    return {body.open_edges, bound_hole_area(body), sharp,
            std::ranges::any_of(body.shell, folds_inward)};
}

// Copies of a mesh are inspected once.
PartShape inspect_parts(const Scene& scene, std::uint32_t material) {
    // Of each primitive of a mesh.
    std::map<std::pair<std::uint32_t, std::uint32_t>,
             std::vector<std::pair<const Primitive*, PartShape>>>
        known_of;
    PartShape all;
    for (const std::vector<std::uint32_t>& part : list_parts_apart(scene, material)) {
        const Primitive& first = scene.primitives[part.front()];
        std::optional<PartShape> own;
        auto& known = known_of[{first.mesh, first.primitive}];
        for (const auto& [of, shape] : known) {
            if (own) break;
            if (const auto scale = part.size() == 1 ? scale_of_copy(first, *of) : std::nullopt) {
                own = shape;
                own->hole_area *= *scale * *scale;
                own->sharp *= *scale;
            }
        }
        if (!own) {
            constexpr std::size_t kMostKnown = 16;  // of one mesh, stretched in different ways
            own = inspect_part(scene, part);
            if (part.size() == 1 && known.size() < kMostKnown) known.emplace_back(&first, *own);
        }
        all.open_edges += own->open_edges;
        all.hole_area += own->hole_area;
        all.sharp += own->sharp;
        all.folds = all.folds || own->folds;
    }
    return all;
}

// Holes of media, and the horizon of receivers. The `tree` of the whole scene is built on first
// use.
void inspect_shape(const Scene& scene, std::uint32_t material, const Ends& ends, SceneFacts& facts,
                   HorizonTree& tree, Searches& searches) {
    MaterialFacts& own = facts.material[material];
    const bool sees = sees_at_a_glance(scene, material, ends, searches.flat);
    if (sees && !scene.materials[material].medium) return;
    const PartShape shape = inspect_parts(scene, material);
    own.open_edges = shape.open_edges;
    own.sharp_edges = shape.sharp;
    if (shape.open_edges > 0) {
        own.holes = own.area > 0 ? shape.hole_area / own.area : 1;
    }
    if (!sees && !shape.folds) {  // in a part that folds inward some receiver sees it
        if (tree.node.empty()) {
            tree = make_horizon_tree(scene);
        }
        own.horizon.elevation = find_elevation(scene, tree, material, searches);
    }
}

}  // namespace

bool SceneFacts::is_open() const {
    return std::all_of(material.begin(), material.end(), [](const MaterialFacts& facts) {
        return facts.receivers == 0 || facts.horizon.elevation <= kMostElevation;
    });
}

SceneFacts inspect_scene(const Scene& scene, formats::Slots slots) {
    SceneFacts facts;
    facts.slots = std::move(slots);
    facts.material.resize(scene.materials.size());
    std::vector<std::optional<glm::dvec3>> origin(scene.materials.size());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        facts.material[primitive.material].receivers +=
            count_receivers_of(scene, facts.slots.view(), p);
        std::optional<glm::dvec3>& of_material = origin[primitive.material];
        if (!of_material && !primitive.position.empty()) {
            of_material = primitive.position[0];
        }
        inspect_primitive(primitive, of_material.value_or(glm::dvec3(0)),
                          facts.material[primitive.material]);
    }
    glm::vec3 largest(0);
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        MaterialFacts& own = facts.material[m];
        if (own.receivers > 0) {
            inspect_colors(scene, m, own);
            own.mean_edge /= std::max(1.0, 3 * own.triangles);
            facts.triangles += own.triangles;
            facts.receivers += own.receivers;
            largest = glm::max(largest, glm::max(glm::abs(own.low), glm::abs(own.high)));
        }
    }
    inspect_surroundings(scene, facts);
    find_nested_media(scene, facts);
    find_things_inside(scene, facts);
    constexpr float kRoundings = 4 * 0x1p-23f;
    Searches searches{
        static_cast<double>(kRoundings * std::max({largest.x, largest.y, largest.z}))};
    const Ends ends = find_ends(scene);
    HorizonTree tree;
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        if (facts.material[m].receivers > 0) {
            inspect_shape(scene, m, ends, facts, tree, searches);
        }
    }
    return facts;
}

}  // namespace opaline::bake
