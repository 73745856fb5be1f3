#include "bake/reference/reference_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/reference/ggx.h"

namespace opaline::bake {

formats::Result<ReferenceScene> make_reference_scene(const formats::Scene& scene,
                                                     unsigned threads) {
    auto surfaces = HitScene::build(scene, threads);
    if (!surfaces) return std::move(surfaces).error();
    ReferenceScene result{std::move(*surfaces),    {}, {}, false, make_volume_space(scene), {},
                          make_lamp_sampler(scene)};
    float densest = 0;
    for (const formats::Material& material : scene.materials) {
        result.medium_of.push_back(formats::kNone);
        const auto number = static_cast<std::uint32_t>(result.medium_of.size() - 1);
        if (material.medium) {
            result.medium_of.back() = static_cast<std::uint32_t>(result.media.size());
            const formats::Medium& m = *material.medium;
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
    RayOrigin from{point};
    for (std::uint32_t i = 0; i < kMostSteps; ++i) {
        const auto hit =
            scene.surfaces.closest_hit(from, direction, std::numeric_limits<float>::infinity());
        if (!hit) break;
        const RayOrigin beyond =
            scene.surfaces.cross(from, direction, *hit, 0, [&](const SurfaceHit& met) {
                if (const std::uint32_t medium = medium_at(scene, met); medium != formats::kNone) {
                    leaving[medium] += glm::dot(direction, met.flat) > 0 ? 1 : -1;
                }
            });
        from = go_straight_on(from, beyond);
    }
    return leaving;
}

}  // namespace

RayOrigin cross_boundary(const ReferenceScene& scene, const RayOrigin& origin, glm::vec3 direction,
                         const SurfaceHit& hit, std::uint32_t key, SurroundingMedia& stack) {
    return scene.surfaces.cross(origin, direction, hit, key, [&](const SurfaceHit& met) {
        if (const std::uint32_t medium = medium_at(scene, met); medium != formats::kNone) {
            glm::dot(direction, met.flat) < 0 ? stack.enter(medium) : stack.leave(medium);
        }
    });
}

SurroundingMedia surrounding_media(const ReferenceScene& scene, glm::vec3 point, glm::vec3 up) {
    SurroundingMedia stack;
    if (scene.media.empty()) return stack;
    const glm::vec3 side = glm::normalize(
        glm::cross(up, std::abs(up.x) > 0.7f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    std::vector<std::vector<int>> votes;
    for (const float tilt : {0.03f, -1.1f, 0.8f}) {
        votes.push_back(count_leaving(scene, point, glm::normalize(up + tilt * side)));
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

void SurroundingMedia::enter(std::uint32_t m) {
    if (size < kCapacity) {
        medium[size++] = m;
    }
}

void SurroundingMedia::leave(std::uint32_t m) {
    for (std::uint32_t i = size; i-- > 0;) {
        if (medium[i] == m) {
            for (std::uint32_t j = i + 1; j < size; ++j) {
                medium[j - 1] = medium[j];
            }
            --size;
            return;
        }
    }
}

}  // namespace opaline::bake
