#include "bake/reference/reference_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/reference/ggx.h"
#include "bake/scene/body_shells.h"
#include "bake/scene/nested_media.h"

namespace opaline::bake {

formats::Result<ReferenceScene> make_reference_scene(const formats::Scene& scene,
                                                     unsigned threads) {
    auto surfaces = HitScene::build(scene, threads);
    if (!surfaces) return std::move(surfaces).error();
    ReferenceScene result{.surfaces = std::move(*surfaces),
                          .media = {},
                          .medium_of = {},
                          .volumes = make_volume_space(scene),
                          .clearance = {},
                          .lamps = make_lamp_sampler(scene)};
    float densest = 0;
    result.medium_of.assign(scene.materials.size(), formats::kNone);
    for (const std::uint32_t number : order_media(scene)) {
        result.medium_of[number] = static_cast<std::uint32_t>(result.media.size());
        const formats::Medium& m = *scene.materials[number].medium;
        result.is_closed = result.is_closed && make_body_shells(scene, number).open_edges == 0;
        ReferenceMedium medium;
        medium.sigma_s = {m.sigma_s.r, m.sigma_s.g, m.sigma_s.b};
        medium.sigma_t = medium.sigma_s + glm::vec3(m.sigma_a.r, m.sigma_a.g, m.sigma_a.b);
        medium.eta = m.eta;
        if (has_rough_boundary(m)) {
            medium.boundary_alpha = static_cast<float>(ggx_alpha(double{m.roughness}));
        }
        medium.phase = make_phase_sampler(m.phase);
        if (m.variation) {
            medium.field.emplace(scene, number);
        }
        result.has_matched_boundary = result.has_matched_boundary || is_matched(m.eta);
        densest = std::max({densest, medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z});
        result.media.push_back(std::move(medium));
    }
    if (densest > 0) {
        // cell size in mean free paths: fine enough to save most rays
        constexpr float kFreePaths = 0.5f;
        result.clearance = ClearanceGrid(scene, result.surfaces.centre(),
                                         result.surfaces.half_size(), kFreePaths / densest);
    }
    return result;
}

namespace {

std::uint32_t medium_at(const ReferenceScene& scene, const SurfaceHit& hit) {
    return scene.medium_of[scene.surfaces.scene().primitives[hit.primitive].material];
}

// Exits minus entries of each medium's bodies along a line.
std::vector<int> count_leaving(const ReferenceScene& scene, glm::vec3 point, glm::vec3 direction) {
    std::vector<int> leaving(scene.media.size());
    for (const SurfaceHit& met :
         scene.surfaces.all_hits({point}, direction, std::numeric_limits<float>::infinity(), 0)) {
        if (const std::uint32_t medium = medium_at(scene, met); medium != formats::kNone) {
            leaving[medium] += glm::dot(direction, met.flat) > 0 ? 1 : -1;
        }
    }
    return leaving;
}

// Around a line up to its next surface; a line that meets none is outside of all.
SurroundingMedia bodies_ahead(const ReferenceScene& scene, const RayOrigin& from,
                              glm::vec3 direction, std::uint32_t key) {
    const auto next =
        scene.surfaces.closest_hit(from, direction, std::numeric_limits<float>::infinity(), key);
    return next ? surrounding_media(scene, from.position + 0.5f * next->distance * direction,
                                    direction)
                : SurroundingMedia{};
}

}  // namespace

RayOrigin cross_boundary(const ReferenceScene& scene, const RayOrigin& origin, glm::vec3 direction,
                         const SurfaceHit& hit, std::uint32_t key, SurroundingMedia& stack) {
    constexpr float kAtEdge = 1e-4f;  // of a triangle: the one beside it may be met as well
    bool is_sure = std::min({hit.u, hit.v, 1 - hit.u - hit.v}) > kAtEdge;
    std::uint32_t met_here = 0;
    const RayOrigin beyond =
        scene.surfaces.cross(origin, direction, hit, key, [&](const SurfaceHit& met) {
            if (const std::uint32_t medium = medium_at(scene, met); medium != formats::kNone) {
                is_sure = is_sure && ++met_here == 1;
                if (glm::dot(direction, met.flat) < 0) {
                    stack.enter(medium);
                } else if (!stack.leave(medium)) {
                    is_sure = false;
                }
            }
        });
    if (!is_sure) {
        stack = bodies_ahead(scene, go_straight_on(origin, beyond), direction, key);
    }
    return beyond;
}

SurroundingMedia surrounding_media(const ReferenceScene& scene, glm::vec3 point, glm::vec3 up) {
    SurroundingMedia stack;
    if (scene.media.empty()) return stack;
    const glm::vec3 side = glm::normalize(
        glm::cross(up, std::abs(up.x) > 0.7f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    std::vector<std::vector<int>> votes;
    const glm::vec3 across = glm::cross(up, side);
    // In no plane of common models: a line through an edge would meet both of its triangles.
    for (const glm::vec2 tilt : {glm::vec2(0.13f, 0.037f), {-0.91f, 0.617f}, {0.43f, -0.674f}}) {
        votes.push_back(
            count_leaving(scene, point, glm::normalize(up + tilt.x * side + tilt.y * across)));
    }
    for (std::uint32_t m = 0; m < scene.media.size(); ++m) {
        std::array<int, 3> count{votes[0][m], votes[1][m], votes[2][m]};
        std::sort(count.begin(), count.end());
        for (int i = 0; i < count[1]; ++i) {
            stack.enter(m);
        }
    }
    return stack;
}

bool SurroundingMedia::contains(std::uint32_t m) const {
    return std::any_of(bodies, bodies + size, [m](const Bodies& b) { return b.medium == m; });
}

void SurroundingMedia::enter(std::uint32_t m) {
    std::uint32_t at = 0;
    while (at < size && bodies[at].medium < m) {
        ++at;
    }
    if (at < size && bodies[at].medium == m) {
        ++bodies[at].count;
        return;
    }
    if (size == kCapacity) {
        if (at == 0) return;
        std::copy(bodies + 1, bodies + at, bodies);
        bodies[at - 1] = {m, 1};
        return;
    }
    std::copy_backward(bodies + at, bodies + size, bodies + size + 1);
    bodies[at] = {m, 1};
    ++size;
}

bool SurroundingMedia::leave(std::uint32_t m) {
    Bodies* const end = bodies + size;
    Bodies* const own = std::find_if(bodies, end, [m](const Bodies& b) { return b.medium == m; });
    if (own == end) return false;
    if (--own->count == 0) {
        std::copy(own + 1, end, own);
        --size;
    }
    return true;
}

}  // namespace opaline::bake
