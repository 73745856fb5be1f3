#include "bake/reference/volume_flight.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

float largest(glm::vec3 v) {
    return std::max({v.x, v.y, v.z});
}

// What passes the optical depths `depth` relative to one channel, so that nothing underflows.
glm::vec3 passing_share(glm::vec3 depth, int channel) {
    return glm::exp(depth[channel] - depth);
}

/// From `begin` to `end` [m] along a ray: the sum over stretches of cells that glow of length times
/// radiance per metre times weight_at(t), at one point t of each.
template <class WeightAt>
glm::vec3 gather_glow(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float begin,
                      float end, RandomStream& random, WeightAt&& weight_at) {
    constexpr float kInverse = 1.0f / formats::SparseGrid<float>::kSide;
    glm::vec3 sum(0);
    for (const GlowingVolume& volume : space.glowing) {
        LatticeRay ray;
        if (!ray.start(kInverse * (volume.to_index * from + volume.offset),
                       kInverse * (volume.to_index * direction), begin, end, volume.first,
                       volume.extent)) {
            continue;
        }
        do {
            const glm::ivec3 c = ray.cell - volume.first;
            const std::size_t cell =
                (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(volume.extent.y) +
                 static_cast<std::size_t>(c.y)) *
                    static_cast<std::size_t>(volume.extent.x) +
                static_cast<std::size_t>(c.x);
            const float length = ray.end - ray.begin;
            if (volume.glows[cell] && length > 0) {
                const float t = ray.begin + random.next() * length;
                sum += length * volume.at(from + t * direction) * weight_at(t);
            }
        } while (ray.advance());
    }
    return sum;
}

}  // namespace

VolumeFlight sample_volume_flight(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction,
                                  float reach, glm::vec3 beta, RandomStream& random,
                                  bool gathers_glow) {
    VolumeFlight flight;
    flight.distance = reach;
    VolumeMarch march(space, from, direction, reach);
    glm::vec3 odds = beta / (beta.x + beta.y + beta.z);
    int channel = draw_channel(odds, random.next());
    float left = -std::log(1 - random.next());  // optical depth to the next possible collision
    glm::vec3 depth(0);                         // since the last one
    // Radiance of volumes from `gathered` to `end`, along which the bounds are `sigma`.
    float gathered = 0;
    const auto glow_up_to = [&](float end, glm::vec3 sigma) {
        if (!gathers_glow || !(end > gathered)) return;
        flight.emitted += gather_glow(space, from, direction, gathered, end, random, [&](float t) {
            const glm::vec3 passing = passing_share(depth + (t - gathered) * sigma, channel);
            return flight.weight * passing / glm::dot(odds, passing);
        });
        gathered = end;
    };
    while (const auto segment = march.next()) {
        glow_up_to(segment->begin, glm::vec3(0));
        // Steps may be shorter than a float of `at` resolves: those still left to go do.
        const float length = segment->end - segment->begin;
        const glm::vec3 sigma = segment->sigma_t;
        double way = 0;
        for (;;) {
            const float rest = static_cast<float>(static_cast<double>(length) - way);
            const float free = sigma[channel] > 0 ? left / sigma[channel] : reach;
            if (!(free < rest)) {
                glow_up_to(segment->end, sigma);
                depth += rest * sigma;
                left = std::max(0.0f, left - rest * sigma[channel]);
                break;
            }
            way += static_cast<double>(free);
            const float at = segment->begin + static_cast<float>(way);
            glow_up_to(at, sigma);
            depth += free * sigma;
            // Which volume: in proportion to its part of the bound in the channel drawn.
            float u = random.next() * sigma[channel];
            std::uint32_t v = 0;
            for (std::uint32_t i = 0; i < space.volumes.size(); ++i) {
                const float part = segment->bound[i] * space.volumes[i].sigma_t[channel];
                if (part > 0) {
                    v = i;
                    if (u < part) break;
                    u -= part;
                }
            }
            const TrackedVolume& volume = space.volumes[v];
            const glm::vec3 passing = passing_share(depth, channel) * volume.sigma_t;
            flight.weight *= passing / glm::dot(odds, passing);
            const float density = volume.density(from + at * direction);
            const bool is_real = random.next() * segment->bound[v] < density;
            if (is_real) {
                flight.weight *= volume.albedo(from + at * direction);
            }
            if (is_real || !(glm::dot(beta, flight.weight) > 0)) {
                flight.collides = true;
                flight.distance = at;
                flight.volume = v;
                return flight;
            }
            odds = beta * flight.weight;
            odds /= odds.x + odds.y + odds.z;
            channel = draw_channel(odds, random.next());
            left = -std::log(1 - random.next());
            depth = glm::vec3(0);
        }
    }
    glow_up_to(reach, glm::vec3(0));
    const glm::vec3 passing = passing_share(depth, channel);
    flight.weight *= passing / glm::dot(odds, passing);
    return flight;
}

glm::vec3 estimate_transmittance(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction,
                                 float reach, RandomStream& random) {
    constexpr float kLittle = 0.1f;
    VolumeMarch march(space, from, direction, reach);
    glm::vec3 passing(1);
    float left = -std::log(1 - random.next());
    while (const auto segment = march.next()) {
        const float densest = largest(segment->sigma_t);
        const float length = segment->end - segment->begin;
        double way = 0;
        for (;;) {
            const float rest = static_cast<float>(static_cast<double>(length) - way);
            const float free = left / densest;
            if (!(free < rest)) {
                left = std::max(0.0f, left - rest * densest);
                break;
            }
            way += static_cast<double>(free);
            const float at = segment->begin + static_cast<float>(way);
            glm::vec3 sigma_t(0);
            for (std::size_t i = 0; i < space.volumes.size(); ++i) {
                if (segment->bound[i] > 0) {
                    const TrackedVolume& v = space.volumes[i];
                    sigma_t +=
                        std::min(v.density(from + at * direction), segment->bound[i]) * v.sigma_t;
                }
            }
            passing *= glm::max(glm::vec3(0), 1.0f - sigma_t / densest);
            const float most = largest(passing);
            if (most < kLittle) {
                if (!(random.next() * kLittle < most)) return glm::vec3(0);
                passing *= kLittle / most;
            }
            left = -std::log(1 - random.next());
        }
    }
    return passing;
}

}  // namespace opaline::bake
