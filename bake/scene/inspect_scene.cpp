#include "bake/scene/inspect_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "bake/scene/body_shells.h"
#include "bake/scene/holes.h"
#include "bake/scene/horizon.h"
#include "bake/scene/nested_media.h"
#include "bake/scene/scene_facts.h"
#include "bake/scene/sent_share.h"

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

// True if, for each point of the shell, all other points lie below its tangent plane. The tangent
// plane is normal to the sum of the adjacent area vectors: for a convex body each facet's plane
// supports the body, and so does any plane between them.
bool is_convex(const BodyShells& body, const BodyShell& shell, Searches& searches) {
    const double outward = shell.volume < 0 ? -1 : 1;
    Triangles triangles;
    std::vector<std::pair<std::uint32_t, glm::dvec3>> normal;  // by point
    for (std::uint32_t i = shell.first; i < shell.first + shell.count; ++i) {
        const BodyTriangle& t = body.triangle[body.order[i]];
        triangles.push_back(
            {body.position[t.point[0]], body.position[t.point[1]], body.position[t.point[2]]});
        for (const std::uint32_t p : t.point) {
            normal.emplace_back(p, outward * area_vector(body, t));
        }
    }
    std::stable_sort(normal.begin(), normal.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const HorizonTree tree = make_horizon_tree(std::move(triangles));
    HorizonSearch search = searches.start();
    for (std::size_t i = 0, end = 0; i < normal.size() && !search.is_over(); i = end) {
        glm::dvec3 sum(0);
        for (; end < normal.size() && normal[end].first == normal[i].first; ++end) {
            sum += normal[end].second;
        }
        const double length = glm::length(sum);
        if (length > 0) {
            look_over_horizon(tree, body.position[normal[i].first], sum / length, search);
        }
    }
    searches.nodes_left = search.nodes_left;
    return !search.is_over();
}

// Size, colours and the tilt of shading normals against their facets. Volumes are those of cones
// with their tip at `origin`, a point of the material's surface, so that holes take little away.
void inspect_primitive(const Primitive& primitive, glm::dvec3 origin, MaterialFacts& facts) {
    facts.receivers += static_cast<double>(primitive.position.size());
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

// Parts, their convexity, and the horizon of their receivers. The `tree` of the whole scene is
// built on first use.
void inspect_shape(const Scene& scene, std::uint32_t material, SceneFacts& facts, HorizonTree& tree,
                   Searches& searches) {
    MaterialFacts& own = facts.material[material];
    const BodyShells body = make_body_shells(scene, material);
    own.open_edges = body.open_edges;
    if (body.open_edges > 0) {
        own.holes = own.area > 0 ? bound_hole_area(body) / own.area : 1;
    }
    own.parts = static_cast<std::uint32_t>(body.shell.size());
    const bool may_be_open = std::none_of(body.shell.begin(), body.shell.end(), folds_inward);
    if (may_be_open) {  // in a non-convex part some receiver sees another point of it
        if (tree.node.empty()) {
            tree = make_horizon_tree(scene);
        }
        own.horizon.elevation = find_elevation(scene, tree, material, searches);
    }
    if (body.shell.size() == 1 && own.horizon.elevation <= kMostElevation) {
        own.convex_parts = 1;  // all points lie below every tangent plane
        return;
    }
    for (const BodyShell& shell : body.shell) {
        own.convex_parts += !folds_inward(shell) && is_convex(body, shell, searches) ? 1 : 0;
    }
}

}  // namespace

bool SceneFacts::is_open() const {
    return std::all_of(material.begin(), material.end(), [](const MaterialFacts& facts) {
        return facts.receivers == 0 || facts.horizon.elevation <= kMostElevation;
    });
}

SceneFacts inspect_scene(const Scene& scene) {
    SceneFacts facts;
    facts.material.resize(scene.materials.size());
    std::vector<std::optional<glm::dvec3>> origin(scene.materials.size());
    for (const Primitive& primitive : scene.primitives) {
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
    constexpr float kRoundings = 4 * 0x1p-23f;
    Searches searches{
        static_cast<double>(kRoundings * std::max({largest.x, largest.y, largest.z}))};
    HorizonTree tree;
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        if (facts.material[m].receivers > 0) {
            inspect_shape(scene, m, facts, tree, searches);
        }
    }
    return facts;
}

}  // namespace opaline::bake
