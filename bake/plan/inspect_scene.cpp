#include "bake/plan/inspect_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bake/plan/color_contrast.h"
#include "bake/plan/horizon.h"
#include "bake/receivers/body_shells.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;
using Triangles = std::vector<HorizonTree::Triangle>;

// Nodes of the trees that may be looked at, for the whole scene: some tenths of a second.
constexpr std::int64_t kMostNodes = 40'000'000;

HorizonSearch start_search(std::int64_t nodes_left) {
    return {kLeastElevation, kMostElevation, nodes_left};
}

// Whether each point of the shell has all its others below its tangent plane. That is the plane
// across the sum of its triangles' area vectors: of a convex body, each of their planes has all of
// it on one side, and so has any plane between them.
bool is_convex(const BodyShells& body, const BodyShell& shell, std::int64_t& nodes_left) {
    // What faces inward is convex seen from its other side.
    const double outward = shell.volume < 0 ? -1 : 1;
    if ((outward > 0 ? shell.valley : shell.ridge) > kMostElevation) {
        return false;  // and most shells that are not end here
    }
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
    HorizonSearch search = start_search(nodes_left);
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
    nodes_left = search.nodes_left;
    return !search.is_over();
}

void inspect_parts(const Scene& scene, std::uint32_t material, std::int64_t& nodes_left,
                   MaterialFacts& facts) {
    const BodyShells body = make_body_shells(scene, material);
    facts.open_edges = body.open_edges;
    facts.parts = static_cast<std::uint32_t>(body.shell.size());
    for (const BodyShell& shell : body.shell) {
        facts.convex_parts += is_convex(body, shell, nodes_left) ? 1 : 0;
    }
}

// Size, colours and how far shading normals lean from their facets.
void inspect_primitive(const Primitive& primitive, MaterialFacts& facts) {
    facts.receivers += static_cast<double>(primitive.position.size());
    facts.triangles += static_cast<double>(primitive.index.size() / 3);
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
        for (std::size_t k = 0; k < 3 && length > 0; ++k) {
            const double cosine = glm::dot(n, glm::dvec3(primitive.normal[v[k]])) / length;
            facts.horizon.behind_facets = std::max(facts.horizon.behind_facets, 0.5 * (1 - cosine));
        }
    }
}

HorizonTree make_tree(const Scene& scene) {
    Triangles triangles;
    for (const Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            triangles.push_back(
                {p.position[p.index[i]], p.position[p.index[i + 1]], p.position[p.index[i + 2]]});
        }
    }
    return make_horizon_tree(std::move(triangles));
}

double find_elevation(const Scene& scene, const HorizonTree& tree, std::uint32_t material,
                      std::int64_t& nodes_left) {
    HorizonSearch search = start_search(nodes_left);
    for (const Primitive& p : scene.primitives) {
        for (std::size_t v = 0; p.material == material && v < p.position.size(); ++v) {
            if (p.normal[v] != glm::vec3(0)) {
                look_over_horizon(tree, p.position[v], glm::dvec3(p.normal[v]), search);
            }
            if (search.is_over()) {
                nodes_left = search.nodes_left;
                return 1;
            }
        }
    }
    nodes_left = search.nodes_left;
    return search.sine;
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
    for (const Primitive& primitive : scene.primitives) {
        inspect_primitive(primitive, facts.material[primitive.material]);
    }
    std::int64_t nodes_left = kMostNodes;
    HorizonTree tree;
    for (std::uint32_t m = 0; m < facts.material.size(); ++m) {
        MaterialFacts& own = facts.material[m];
        if (own.receivers == 0) {
            continue;
        }
        facts.triangles += own.triangles;
        facts.receivers += own.receivers;
        own.mean_edge /= std::max(1.0, 3 * own.triangles);
        const ColorRange color = find_color_range(scene, m);
        own.brightest_vertex = color.brightest_vertex;
        own.color_contrast = color.contrast;
        if (const auto& medium = scene.materials[m].medium) {
            const auto same = [](formats::Rgb c) { return c.r == c.g && c.g == c.b; };
            own.is_grey = same(medium->sigma_s) && same(medium->sigma_a);
            own.mirrors = medium->eta != 1;
        }
        inspect_parts(scene, m, nodes_left, own);
        // In a part that is not convex, some receiver sees another place.
        if (own.convex_parts == own.parts) {
            if (tree.node.empty()) {
                tree = make_tree(scene);
            }
            own.horizon.elevation = find_elevation(scene, tree, m, nodes_left);
        }
    }
    return facts;
}

}  // namespace opaline::bake
