#include "bake/effects/multiple/walks/walk_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"
#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float sum_of(glm::vec3 bands) {
    return bands.x + bands.y + bands.z;
}

}  // namespace

glm::vec3 start_direction(const WalkSpace& space, const WalkStart& start, WalkRandom& random) {
    if (start.seen != glm::vec3(0)) return -start.seen;
    float cosine = 1, azimuth = 0;
    constexpr int kMostTries = 1000;  // one in a hundred is accepted at the most extreme index
    for (int i = 0; i < kMostTries; ++i) {
        cosine = std::sqrt(1 - random.next());
        azimuth = 2 * kPi * random.next();
        if (random.next() < boundary_transmittance(cosine, space.eta)) break;
        cosine = 1;
    }
    const auto inside = static_cast<float>(
        refracted_cosine(static_cast<double>(cosine), static_cast<double>(space.eta)));
    const float sine = std::sqrt(std::max(0.0f, 1 - inside * inside));
    const glm::vec3 tilted(sine * std::cos(azimuth), sine * std::sin(azimuth), -inside);
    const glm::vec3 direction = make_frame(start.normal).to_world(tilted);
    return glm::dot(direction, start.flat) < 0 ? direction
                                               : make_frame(start.flat).to_world(tilted);
}

FarSide find_far_side(const WalkSpace& space, const MediumStack& bodies, glm::vec3 from,
                      glm::vec3 direction, float way, const WalkHit& hit, std::uint64_t& rays) {
    return find_far_side(
        space.bodies ? &*space.bodies : nullptr, space.place_of, bodies,
        {from, direction, way, hit.position, hit.flat, hit.error, hit.u, hit.v, hit.place}, rays);
}

std::optional<WalkReflection> reflect_at(const WalkSpace& space, const WalkHit& hit,
                                         glm::vec3 direction, float u) {
    const formats::Scene& scene = *space.scene;
    const formats::Material& material = scene.materials[scene.primitives[hit.primitive].material];
    const bool is_behind = glm::dot(direction, hit.flat) > 0;
    const bool is_black = is_behind && !material.sheet && !material.double_sided;
    if (is_black || (material.medium && !material.sheet)) return std::nullopt;
    const glm::vec3 toward = is_behind ? -hit.flat : hit.flat;
    glm::vec3 color = base_color(scene, surface_place(scene, hit.primitive, hit.first_index,
                                                      {1 - hit.u - hit.v, hit.u, hit.v}));
    WalkReflection found{toward, {}};
    if (const auto& sheet = material.sheet) {
        const glm::vec3 reflect(sheet->reflect.r, sheet->reflect.g, sheet->reflect.b);
        const glm::vec3 transmit(sheet->transmit.r, sheet->transmit.g, sheet->transmit.b);
        const float both = sum_of(reflect + transmit);
        if (!(both > 0)) return std::nullopt;
        const float chance = sum_of(reflect) / both;
        const bool passes = !(u < chance);
        color *= passes ? transmit / (1 - chance) : reflect / chance;
        found.normal = passes ? -toward : toward;
    }
    if (space.is_grey) color = glm::vec3(sum_of(color) / 3);
    found.albedo = {color.x, color.y, color.z};
    return found;
}

}  // namespace opaline::bake
