#include "bake/exchange/inside_media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/physics/medium_flight.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/cross_bodies.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
bool is_inside(const BounceSpace& space, std::uint32_t material, const SeenSide& side) {
    const formats::Material& of = space.scene.materials[material];
    return !side.is_seen && side.behind && side.normal != glm::vec3(0) && of.medium && !of.sheet &&
           !space.layouts.empty() && !space.layouts[material].layered;
}

bool changes_light(const formats::Medium& medium) {
    return medium.sigma_s != formats::Rgb{} || medium.sigma_a != formats::Rgb{};
}

MediumAround medium_around(const BounceSpace& space, const Receiver& at) {
    const auto holds = [&](const formats::Material& m) { return m.medium && !m.sheet; };
    if (std::ranges::none_of(space.scene.materials, holds)) return {};
    const Frame frame = make_frame(at.normal);
    RayPacket packet = rays_from(at.origin);
    LaneMask lanes{};
    constexpr std::size_t kRays = RayPacket::kSize;
    for (std::size_t i = 0; i < kRays; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / kRays;
        const float v = std::fmod(static_cast<float>(i) * std::numbers::phi_v<float>, 1.0f);
        set_lane(packet, lanes, i, frame.to_world(to_hemisphere(u, v)));
    }
    const PacketHits hits = space.rays.closest(lanes, packet);
    constexpr float kDeep = 32;
    MediumAround around;
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < kRays; ++i) {
        if (hits.hit[i] == 0 ||
            !is_inside(space, hits.material[i], side_of_hit(space.scene, hits, i))) {
            continue;
        }
        if (around.material == formats::kNone) around.material = hits.material[i];
        nearest = std::min(nearest, hits.distance[i]);
    }
    if (around.material != formats::kNone) {
        const std::array<float, 3> sigma_s =
            isotropic_scattering(*space.scene.materials[around.material].medium);
        around.is_deep = nearest * std::ranges::min(sigma_s) > kDeep;
    }
    return around;
}

bool go_on_inside(const BounceSpace& space, const RayEnd& end, MirroredRay& ray,
                  std::uint64_t seed) {
    const bool is_boundary = is_inside(space, end.material, end.side);
    const std::uint32_t around = is_boundary ? end.material : ray.medium;
    if (around == formats::kNone) return false;
    const formats::Medium& medium = *space.scene.materials[around].medium;
    const std::uint64_t key = key_of({end.position, end.direction});
    const auto of_flight = random_uniform(seed, RandomStage::bounce_rays, key, 0);
    const auto of_turn = random_uniform(seed, RandomStage::bounce_rays, key, 1);
    const MediumFlight flight = draw_flight(medium, {ray.share.r, ray.share.g, ray.share.b},
                                            end.distance, of_flight[0], of_flight[1]);
    ray.share = {flight.share[0], flight.share[1], flight.share[2]};
    ray.medium = around;
    ++ray.inside;
    if (flight.length) {
        ray.origin += *flight.length * ray.direction;
        ray.direction = direction_on_sphere(of_turn[0], of_turn[1]);
        return true;
    }
    if (!is_boundary) return false;
    const glm::vec3 outward = -end.side.normal;
    const float ratio = 1 / medium.eta;
    bool leaves = true;
    if (!is_matched(ratio)) {
        const Bend bend = bend_at(outward, outward, end.direction, ratio);
        leaves = of_turn[2] < bend.passed;
        ray.direction = leaves ? bend.refracted : bend.reflected;
    }
    if (leaves) ray.medium = formats::kNone;
    ray.origin = end.position + (leaves ? end.error : -end.error) * outward;
    return true;
}

}  // namespace opaline::bake
