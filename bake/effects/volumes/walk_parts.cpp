#include "bake/effects/volumes/walk_parts.h"

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
    return {hits.distance[0],
            hits.material[0],
            {hits.normal_x[0], hits.normal_y[0], hits.normal_z[0]},
            hits.cosine[0]};
}

bool survives(const std::array<float, 3>& albedo, std::size_t first, std::size_t end,
              std::array<float, 3>& weight, FlightRandom& random) {
    float most = 0;
    for (std::size_t band = first; band < end; ++band) {
        weight[band] *= albedo[band];
        most = std::max(most, std::abs(weight[band]));
    }
    if (most < kWalkRoulette) {
        if (random() * kWalkRoulette >= most) return false;
        for (float& w : weight) {
            w *= kWalkRoulette / most;
        }
    }
    return true;
}

float scattered_harmonic(const ScaledPhase& phase, std::uint32_t k) {
    std::size_t degree = 0;
    while (k >= (degree + 1) * (degree + 1)) {
        ++degree;
    }
    const auto lambda = static_cast<float>(phase.lambda[degree]);
    return degree % 2 == 0 ? lambda : -lambda;
}

glm::vec3 draw_direction(FlightRandom& random) {
    const float z = 1 - 2 * random(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * random();
    return {r * std::cos(angle), r * std::sin(angle), z};
}

WalkCount count_walk(const DensitySpace& space, glm::vec3 at, FlightRandom& random) {
    constexpr float kForever = std::numeric_limits<float>::infinity();
    constexpr std::size_t kGreen = 1;
    WalkCount count;
    glm::vec3 direction = draw_direction(random);
    std::array<float, 3> weight{1, 1, 1};
    for (std::uint32_t n = 0; n < kMostScatterings; ++n) {
        ++count.flights;
        const Collision hit = sample_flight(space, kGreen, at, direction, kForever, random);
        if (!hit.happens) break;
        at += hit.distance * direction;
        const DensityVolume& own = space.volumes[hit.volume];
        if (!survives(own.albedo_at(at), kGreen, kGreen + 1, weight, random)) break;
        ++count.collisions;
        turn_walk(own.phase, direction, random);
    }
    return count;
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
