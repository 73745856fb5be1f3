#include "bake/volumes/walk_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {

glm::vec3 even_direction(std::uint32_t i, std::uint32_t count, float u, float v) {
    constexpr double kGolden = 0.61803398874989485;
    const double z =
        1 - 2 * (static_cast<double>(i) + static_cast<double>(u)) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * kGolden + static_cast<double>(v);
    const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return glm::vec3(glm::dvec3(r * std::cos(angle), r * std::sin(angle), z));
}

MetSurface find_surface(const RayScene& rays, glm::vec3 from, glm::vec3 direction,
                        std::uint64_t& traced) {
    if (rays.is_empty()) {
        return {};
    }
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    lanes[0] = -1;
    packet.dir_x[0] = direction.x;
    packet.dir_y[0] = direction.y;
    packet.dir_z[0] = direction.z;
    packet.tfar[0] = std::numeric_limits<float>::infinity();
    const PacketHits hits = rays.closest(lanes, packet);
    ++traced;
    if (hits.hit[0] == 0) {
        return {};
    }
    return {hits.distance[0], hits.primitive[0], hits.first_index[0],
            hits.u[0],        hits.v[0],         hits.cosine[0] > 0};
}

SampledCosine turn_walk(const ScaledPhase& phase, glm::vec3& direction, FlightRandom& random) {
    const SampledCosine sampled = sample_scaled(phase, random());
    const float angle = 2 * std::numbers::pi_v<float> * random();
    const float sine = std::sqrt(std::max(0.0f, 1 - sampled.cosine * sampled.cosine));
    direction = make_frame(direction).to_world(
        {sine * std::cos(angle), sine * std::sin(angle), sampled.cosine});
    direction = glm::normalize(direction);
    return sampled;
}

}  // namespace opaline::bake
