#include "bake/trace/stand_ins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bake/base/ordered_parallel.h"
#include "bake/scene/triangle.h"

namespace opaline::bake {
namespace {

struct OwnVertex {
    glm::vec3 position, normal;
    std::uint32_t number;  // of the scene
};

// Whether there is no body before the triangle near some of its corners.
std::vector<std::uint8_t> seen_corners(const BodiesAt& bodies, const formats::Primitive& p,
                                       std::size_t first_index) {
    constexpr float kInward = 0.05f;  // edges of triangles lie on those of other bodies
    std::vector<std::uint8_t> seen(3);
    const glm::vec3 normal = triangle_normal(p, first_index / 3);
    if (normal == glm::vec3(0)) return seen;
    glm::vec3 middle(0);
    for (std::size_t k = 0; k < 3; ++k) {
        middle += p.position[p.index[first_index + k]] / 3.0f;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 at = glm::mix(p.position[p.index[first_index + k]], middle, kInward);
        seen[k] = bodies.material_at(at + 2 * bodies.touch() * normal) == formats::kNone ? 1 : 0;
    }
    return seen;
}

// Of a primitive's vertices; `meets`: its material touches or overlaps others.
std::vector<std::uint8_t> seen_vertices(const BodiesAt& bodies, const formats::Primitive& p,
                                        bool meets, const Context& context) {
    std::vector<std::uint8_t> seen(p.position.size());
    constexpr std::size_t kBlock = 256;
    for_each_block_in_order(
        p.index.size() / 3, kBlock, context,
        [&](Range range) {
            std::vector<std::uint8_t> corners;
            for (std::size_t t = range.begin; t < range.end; ++t) {
                const auto own =
                    meets ? seen_corners(bodies, p, 3 * t) : std::vector<std::uint8_t>(3, 1);
                corners.insert(corners.end(), own.begin(), own.end());
            }
            return corners;
        },
        [&](Range range, std::vector<std::uint8_t>&& corners) {
            for (std::size_t c = 0; c < corners.size(); ++c) {
                std::uint8_t& of = seen[p.index[3 * range.begin + c]];
                of = std::max(of, corners[c]);
            }
        });
    return seen;
}

// `sorted` along x.
std::uint32_t nearest_seen(std::span<const OwnVertex> sorted, const OwnVertex& hidden) {
    constexpr float kAlike = 0.7f, kOtherWay = 2;
    const auto middle = std::ranges::lower_bound(sorted, hidden.position.x, {},
                                                 [](const OwnVertex& v) { return v.position.x; });
    float least = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = hidden.number;
    const auto look_at = [&](const OwnVertex& v) {
        if (!(std::abs(v.position.x - hidden.position.x) < least)) return false;
        const float factor = glm::dot(v.normal, hidden.normal) > kAlike ? 1 : kOtherWay;
        const float distance = factor * glm::distance(v.position, hidden.position);
        if (distance < least || (distance == least && v.number < nearest)) {
            least = distance;
            nearest = v.number;
        }
        return true;
    };
    for (auto v = middle; v != sorted.end() && look_at(*v); ++v) {
    }
    for (auto v = middle; v != sorted.begin() && look_at(*(v - 1)); --v) {
    }
    return nearest;
}

}  // namespace

std::vector<std::uint32_t> find_stand_ins(const formats::Scene& scene, const SceneFacts& facts,
                                          const EmbreeScene& triangles, const Context& context) {
    std::size_t count = 0;
    for (const formats::Primitive& p : scene.primitives) {
        count += p.position.size();
    }
    std::vector<std::uint32_t> stand_in(count);
    std::iota(stand_in.begin(), stand_in.end(), 0u);
    if (triangles.triangles() == 0) return stand_in;
    const BodiesAt bodies(scene, triangles);
    for (const std::uint32_t material : bodies.order()) {
        const auto& inner = facts.material[material].inner;
        std::vector<std::uint8_t> is_own(scene.materials.size());
        is_own[material] = 1;
        const bool meets =
            std::ranges::any_of(inner, [](const InnerMedium& i) { return i.depth == 0; }) ||
            facts.material[material].overlaps || bodies.has_faces_on_faces(scene, is_own);
        std::vector<OwnVertex> seen, hidden;
        std::uint32_t first = 0;
        for (const formats::Primitive& p : scene.primitives) {
            if (p.material == material) {
                const std::vector<std::uint8_t> own = seen_vertices(bodies, p, meets, context);
                for (std::size_t v = 0; v < own.size(); ++v) {
                    (own[v] != 0 ? seen : hidden)
                        .push_back(
                            {p.position[v], p.normal[v], first + static_cast<std::uint32_t>(v)});
                }
            }
            first += static_cast<std::uint32_t>(p.position.size());
        }
        std::ranges::stable_sort(seen, {}, [](const OwnVertex& v) { return v.position.x; });
        for (const OwnVertex& v : hidden) {
            stand_in[v.number] = nearest_seen(seen, v);
        }
    }
    return stand_in;
}

}  // namespace opaline::bake
