#include "bake/exchange/lamps/receiver_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/straight_light.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr double kNear = 0.01;  // of the scene: a receiver's surface is not farther
constexpr std::uint32_t kLeastGlowRays = 16;

// Adds the mean of each lamp's elements around a receiver: rays down to them in a cone, at a vertex
// to some of those that meet there. They start above it: at an edge receivers lie beside the face.
void add_elements(const LampLight& light, const ElementLayout& layout,
                  std::span<const ElementLight> of_lamps, const Receiver& receiver,
                  std::span<glm::dvec3> total, std::uint64_t& rays) {
    if (std::ranges::all_of(of_lamps, &ElementLight::empty)) return;
    constexpr std::uint32_t kRays = 8;
    constexpr double kAbove = 1e-4;  // of the scene
    const double radius = light.sources.front().radius;
    RayPacket packet =
        rays_from(receiver.origin + static_cast<float>(kAbove * radius) * receiver.normal);
    LaneMask lanes{};
    const Frame frame = make_frame(receiver.normal);
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const float turn = std::numbers::pi_v<float> * (2 * static_cast<float>(i) + 1) / kRays;
        set_lane(packet, lanes, i,
                 glm::normalize(frame.to_world({std::cos(turn), std::sin(turn), -1})),
                 static_cast<float>(kNear * radius));
    }
    rays += kRays;
    const PacketHits hits = light.rays.closest(lanes, packet);
    std::array<std::size_t, kRays> elements{};
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const auto at = arrival_of(hits, i);
        if (!at || glm::dot(at->normal, glm::dvec3(receiver.normal)) < 0.5) continue;
        const std::size_t element = layout.element(at->side, at->weights);
        if (element < layout.size()) elements[count++] = element;
    }
    for (std::size_t lamp = 0; lamp < of_lamps.size(); ++lamp) {
        if (of_lamps[lamp].empty()) continue;
        for (std::size_t i = 0; i < count; ++i) {
            total[lamp] +=
                glm::dvec3(of_lamps[lamp].irradiance[elements[i]]) / static_cast<double>(count);
        }
    }
}

}  // namespace

std::vector<glm::dvec3> receive_straight(const LampLight& light, const Receiver& receiver,
                                         std::uint64_t& rays) {
    std::vector<glm::dvec3> total(light.sources.size(), glm::dvec3(0));
    if (receiver.normal == glm::vec3(0)) return total;
    add_caustics(light, receiver, total, rays);
    for (std::size_t lamp = 0; lamp < total.size(); ++lamp) {
        total[lamp] += straight_irradiance(light.rays, light.sources[lamp], receiver, light.samples,
                                           rays, light.volumes);
    }
    return total;
}

void add_from_volumes(const LampLight& light, const Receiver& receiver, std::uint64_t key,
                      std::span<glm::dvec3> total, std::uint64_t& rays) {
    if (receiver.normal == glm::vec3(0)) return;
    for (std::size_t lamp = 0; lamp < light.glow.size(); ++lamp) {
        if (!light.glow[lamp]) continue;
        const auto turn = random_uniform(light.seed, RandomStage::gather_rays, key,
                                         ~static_cast<std::uint32_t>(lamp));
        total[lamp] +=
            glow_irradiance(*light.glow[lamp], light.rays, receiver,
                            std::max(kLeastGlowRays, light.samples / 4), {turn[0], turn[1]}, rays);
    }
}

void add_caustics(const LampLight& light, const Receiver& receiver, std::span<glm::dvec3> total,
                  std::uint64_t& rays) {
    if (light.layout != nullptr) {
        add_elements(light, *light.layout, light.caustics, receiver, total, rays);
    }
}

std::vector<glm::dvec3> leaving_exitance(const LampLight& light, const Receiver& receiver,
                                         std::uint64_t& rays) {
    std::vector<glm::dvec3> total(light.sources.size(), glm::dvec3(0));
    if (light.leaving_layout != nullptr && receiver.normal != glm::vec3(0)) {
        add_elements(light, *light.leaving_layout, light.leaving, receiver, total, rays);
    }
    return total;
}

}  // namespace opaline::bake
