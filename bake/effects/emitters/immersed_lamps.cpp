#include "bake/effects/emitters/immersed_lamps.h"

#include <cmath>
#include <map>
#include <numbers>

#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kMostPlaces = 64;  // of a lamp's triangles

// Evenly spread over the sphere, one for each lane: a spiral of the golden angle.
glm::vec3 spiral_direction(std::size_t i, std::size_t count) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

// The medium around a point. `normal`: rays start on that side of it alone; 0: on all sides.
std::uint32_t medium_at(const formats::Scene& scene, const RayScene& rays, const glm::vec3& from,
                        const glm::vec3& normal) {
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    std::size_t started = 0;
    std::map<std::uint32_t, std::size_t> backs;  // by material
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        const glm::vec3 direction = spiral_direction(i, RayPacket::kSize);
        set_lane(packet, lanes, i, direction);
        lanes[i] = glm::dot(direction, normal) >= 0 ? -1 : 0;
        started += lanes[i] != 0 ? 1 : 0;
    }
    const PacketHits hits = rays.closest(lanes, packet);
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] == 0 || hits.hit[i] == 0 || !(hits.cosine[i] > 0)) continue;
        const auto& medium = scene.materials[hits.material[i]].medium;
        if (medium && medium->sigma_s != formats::Rgb{}) ++backs[hits.material[i]];
    }
    for (const auto& [material, count] : backs) {
        if (2 * count > started) return material;
    }
    return formats::kNone;
}

}  // namespace

std::uint32_t medium_around(const formats::Scene& scene, const RayScene& rays,
                            const LampSources& lamp) {
    if (rays.is_empty()) return formats::kNone;
    double all = 0;
    std::map<std::uint32_t, double> inside;  // by material
    const auto count = [&](const glm::dvec3& from, const glm::dvec3& normal,
                           const glm::dvec3& power) {
        const double weight = power.x + power.y + power.z;
        all += weight;
        inside[medium_at(scene, rays, glm::vec3(from), glm::vec3(normal))] += weight;
    };
    const std::size_t step = 1 + lamp.triangles.size() / kMostPlaces;
    for (std::size_t t = 0; t < lamp.triangles.size(); t += step) {
        const GlowingTriangle& triangle = lamp.triangles[t];
        const glm::dvec3 middle =
            (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3.0;
        count(middle + 1e-4 * std::sqrt(triangle.area) * triangle.normal, triangle.normal,
              triangle.power());
    }
    for (const formats::Light& light : lamp.lights) {
        if (light.type == formats::Light::Type::directional) continue;
        count(glm::dvec3(light.position), glm::dvec3(0), light_power(lamp, light));
    }
    for (const auto& [material, power] : inside) {
        if (2 * power > all) return material;
    }
    return formats::kNone;
}

}  // namespace opaline::bake
