#include "bake/reference/light_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/reference/events.h"
#include "bake/reference/volume_flight.h"

namespace opaline::bake {
namespace {

constexpr float kEndless = std::numeric_limits<float>::infinity();

/// Of `distance` [m] through a medium. Where its density varies, an estimate without bias by ratio
/// tracking [Novak2014]: the share that is left at each collision with the densest channel.
glm::vec3 transmittance(const ReferenceMedium& medium, glm::vec3 from, glm::vec3 direction,
                        float distance, RandomStream& random) {
    if (!medium.field || !medium.field->has_density()) return glm::exp(-medium.sigma_t * distance);
    const float densest = std::max({medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z});
    glm::vec3 left(1);
    for (float at = 0; left != glm::vec3(0);) {
        at -= std::log(1 - random.next()) / densest;
        if (!(at < distance)) break;
        left *= 1.0f - medium.field->density(from + at * direction) / densest * medium.sigma_t;
    }
    return left;
}

float index_in(const ReferenceScene& scene, const SurroundingMedia& stack) {
    return stack.empty() ? 1 : scene.media[stack.top()].eta;
}

glm::vec3 pass_volumes(const ReferenceScene& scene, glm::vec3 start, glm::vec3 direction,
                       float reach, RandomStream& random) {
    return scene.volumes.empty()
               ? glm::vec3(1)
               : estimate_transmittance(scene.volumes, start, direction, reach, random);
}

// Between surfaces, in whatever fills the space there.
glm::vec3 pass_space(const ReferenceScene& scene, const SurroundingMedia& stack, glm::vec3 from,
                     glm::vec3 direction, float reach, RandomStream& random) {
    if (stack.empty()) return pass_volumes(scene, from, direction, reach, random);
    return std::isinf(reach)
               ? glm::vec3(0)
               : transmittance(scene.media[stack.top()], from, direction, reach, random);
}

}  // namespace

glm::vec3 pass_line(const PathSpace& space, LightLine line, SurroundingMedia& stack,
                    PathState state, RandomStream& random) {
    const ReferenceScene& scene = space.scene;
    const HitScene& surfaces = scene.surfaces;
    glm::vec3 passing(1);
    std::uint32_t steps = 0;
    while (const auto hit = surfaces.closest_hit(line.from, line.direction, line.reach, line.key)) {
        passing *=
            pass_space(scene, stack, line.from.position, line.direction, hit->distance, random);
        if (hit->primitive == line.primitive && hit->triangle == line.triangle) return passing;
        if (++steps > kMostSteps) return glm::vec3(0);
        const std::uint32_t material = surfaces.scene().primitives[hit->primitive].material;
        const std::uint32_t medium = scene.medium_of[material];
        if (medium == formats::kNone) return glm::vec3(0);
        const bool was_out = stack.empty();
        const std::uint32_t before = stack.top();
        const float eta = index_in(scene, stack);
        const RayOrigin beyond =
            cross_boundary(scene, line.from, line.direction, *hit, line.key, stack);
        if (before != stack.top()) {
            if (!is_matched(index_in(scene, stack) / eta)) return glm::vec3(0);
            state = after_crossing(state, stack.empty());
            if (was_out) {
                passing *= base_color_at(surfaces.scene(), *hit);
            }
        }
        line.from = go_straight_on(line.from, beyond);
        line.reach = std::max(0.0f, line.reach - hit->distance);
    }
    const bool ends_well = line.is_to_sky
                               ? stack.empty() && counts_sky(space, state)
                               : line.triangle == formats::kNone;  // else rounding at an edge
    return ends_well ? passing * pass_space(scene, stack, line.from.position, line.direction,
                                            line.reach, random)
                     : glm::vec3(0);
}

glm::vec3 see_sky(const PathSpace& space, const RayOrigin& from, glm::vec3 direction,
                  SurroundingMedia stack, PathState state, std::uint32_t key,
                  RandomStream& random) {
    if (!space.scene.has_matched_boundary) {
        return stack.empty() && counts_sky(space, state) &&
                       !space.scene.surfaces.is_blocked(from, direction, key)
                   ? pass_volumes(space.scene, from.position, direction, kEndless, random)
                   : glm::vec3(0);
    }
    return pass_line(space, {from, direction, kEndless, formats::kNone, formats::kNone, key, true},
                     stack, state, random);
}

float per_squared_index(const ReferenceScene& scene, const SurroundingMedia& stack) {
    const float eta = index_in(scene, stack);
    return 1 / (eta * eta);
}

}  // namespace opaline::bake
