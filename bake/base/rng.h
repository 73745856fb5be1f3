#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

namespace opaline::bake {

/// The part of a bake that a random number belongs to. It is a word of the counter, so the streams
/// are disjoint.
enum class RandomStage : std::uint32_t {
    held_back_receivers = 1,
    surface_samples = 2,
    bootstrap = 3,
    reference_path = 5,
    reference_receivers = 6,
    check_points = 7,
    pilot_receivers = 8,
    surface_probes = 9,
    body_walk = 10,
    true_body_walk = 11,
    true_straight_views = 13,
    volume_walk = 14,
    volume_rays = 15,
    volume_costs = 16,
    slab_walk = 17,
    layer_check = 18,
    bounce_rays = 19,
    true_bounces = 20,
    particle_starts = 21,
    particle_bounces = 22,
    gather_rays = 23,
    true_gather = 24,
    reference_group = 25,
    volume_glow = 26,
    refine_probes = 27,
    particle_flights = 28
};

/// Four random words, a pure function of the arguments. There is no state, so results do not depend
/// on threads or shards. Philox4x32-10 [Salmon2011].
inline std::array<std::uint32_t, 4> random_bits(std::uint64_t seed, RandomStage stage,
                                                std::uint64_t receiver, std::uint32_t sample = 0) {
    const r123::Philox4x32::ctr_type counter{{static_cast<std::uint32_t>(receiver),
                                              static_cast<std::uint32_t>(receiver >> 32), sample,
                                              static_cast<std::uint32_t>(stage)}};
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
    const auto bits = r123::Philox4x32{}(counter, key);
    return {bits[0], bits[1], bits[2], bits[3]};
}

/// The same as four uniform numbers in [0, 1), 24 bits each.
inline std::array<float, 4> random_uniform(std::uint64_t seed, RandomStage stage,
                                           std::uint64_t receiver, std::uint32_t sample = 0) {
    const auto bits = random_bits(seed, stage, receiver, sample);
    std::array<float, 4> uniform{};
    for (std::size_t i = 0; i < 4; ++i) {
        uniform[i] = static_cast<float>(bits[i] >> 8) * 0x1p-24f;
    }
    return uniform;
}

}  // namespace opaline::bake
