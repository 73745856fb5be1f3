#include "bake/receivers/body_points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <unordered_map>
#include <utility>

#include "bake/scene/weld.h"

namespace opaline::bake {

namespace {

// [m]; the longest of the three bands.
float mean_free_path(const formats::Medium& medium) {
    const formats::Rgb &s = medium.sigma_s, &a = medium.sigma_a;
    return 1 / std::min({s.r + a.r, s.g + a.g, s.b + a.b});
}

// Two of the normals that vertices of media have at one position, as different as there are.
struct TwoNormals {
    glm::vec3 first, other;
};
using NormalsAt = std::unordered_map<glm::vec3, TwoNormals, PositionHash>;

NormalsAt collect_normals(const formats::Scene& scene) {
    NormalsAt normals;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t v = 0; scene.materials[p.material].medium && v < p.position.size(); ++v) {
            const glm::vec3 own = p.normal[v];
            TwoNormals& at =
                normals.try_emplace(weld_key(p.position[v]), TwoNormals{own, own}).first->second;
            if (glm::dot(own, at.first) < glm::dot(at.other, at.first)) {
                at.other = own;
            }
        }
    }
    return normals;
}

bool is_on_sharp_edge(const NormalsAt& normals, glm::vec3 position, glm::vec3 normal) {
    constexpr float kSmooth = 0.7f;  // cosine of normals of one face
    const TwoNormals& at = normals.find(weld_key(position))->second;
    return std::min(glm::dot(at.first, normal), glm::dot(at.other, normal)) < kSmooth;
}

// From each vertex along its tangent plane to the middle of its triangles.
std::vector<glm::vec3> find_ways_inward(const formats::Primitive& p) {
    std::vector<glm::vec3> way(p.position.size(), glm::vec3(0));
    std::vector<float> area(p.position.size(), 0);
    for (std::size_t t = 0; t < p.index.size() / 3; ++t) {
        const std::uint32_t* const v = &p.index[3 * t];
        const std::array<glm::vec3, 3> x{p.position[v[0]], p.position[v[1]], p.position[v[2]]};
        const float own = glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            way[v[k]] += own * ((x[0] + x[1] + x[2]) / 3.0f - x[k]);
            area[v[k]] += own;
        }
    }
    for (std::size_t v = 0; v < way.size(); ++v) {
        way[v] = area[v] > 0 ? way[v] / area[v] : glm::vec3(0);
        way[v] -= glm::dot(way[v], p.normal[v]) * p.normal[v];
    }
    return way;
}

}  // namespace

std::vector<BodyPoint> make_body_points(const formats::Scene& scene,
                                        std::span<const Receiver> receivers) {
    constexpr float kFreePaths = 2;  // light from the side is down to 2 %
    const NormalsAt normals = collect_normals(scene);
    std::vector<BodyPoint> points;
    points.reserve(receivers.size());
    for (const formats::Primitive& p : scene.primitives) {
        const auto& medium = scene.materials[p.material].medium;
        const std::vector<glm::vec3> inward =
            medium ? find_ways_inward(p) : std::vector<glm::vec3>();
        for (std::size_t v = 0; v < p.position.size(); ++v) {
            const Receiver& receiver = receivers[points.size()];
            const glm::vec3 clearance = receiver.origin - p.position[v];
            BodyPoint& point = points.emplace_back(
                BodyPoint{p.position[v], glm::vec3(0), p.position[v] - clearance, p.material});
            if (medium) {
                point.normal = receiver.normal;
                const float length = glm::length(inward[v]), paths = mean_free_path(*medium);
                if (length > 0 && is_on_sharp_edge(normals, p.position[v], p.normal[v])) {
                    point.aside = std::min(1.0f, kFreePaths * paths / length) * inward[v];
                }
            }
        }
    }
    return points;
}

BodyPoint step_aside(BodyPoint point) {
    point.position += point.aside;
    point.inner += point.aside;
    point.aside = glm::vec3(0);
    return point;
}

std::vector<ReceiverSet> make_vertex_sets(const formats::Scene& scene,
                                          std::span<const Receiver> outside,
                                          std::span<const BodyPoint> inside) {
    assert(outside.size() == inside.size());
    std::vector<ReceiverSet> sets;
    std::size_t first = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        const std::size_t count = primitive.position.size();
        ReceiverSet set;
        set.material = primitive.material;
        set.primitive = p;
        set.first = static_cast<std::uint32_t>(first);
        const auto outer = outside.subspan(first, count);
        const auto inner = inside.subspan(first, count);
        set.outside.assign(outer.begin(), outer.end());
        set.inside.assign(inner.begin(), inner.end());
        sets.push_back(std::move(set));
        first += count;
    }
    return sets;
}

const ReceiverSet& set_of(std::span<const ReceiverSet> sets, std::uint32_t receiver) {
    const auto after =
        std::upper_bound(sets.begin(), sets.end(), receiver,
                         [](std::uint32_t r, const ReceiverSet& s) { return r < s.first; });
    // Empty sets begin where the next one does: the last one that begins at or before holds it.
    assert(after != sets.begin());
    return *(after - 1);
}

std::uint32_t count_receivers(std::span<const ReceiverSet> sets) {
    return sets.empty() ? 0 : sets.back().first + static_cast<std::uint32_t>(sets.back().size());
}

}  // namespace opaline::bake
