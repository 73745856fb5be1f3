#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/reference/random_stream.h"
#include "bake/reference/volume_space.h"

namespace opaline::bake {

/// A flight through volumes and what ended it.
struct VolumeFlight {
    bool collides = false;     ///< scattered at `distance`; else it came as far as it was to go
    float distance = 0;        ///< [m]
    std::uint32_t volume = 0;  ///< that scatters
    glm::vec3 weight{1};       ///< contribution over density, albedo included
    /// What volumes send out by themselves on the way, per throughput [W m^-2 sr^-1]. Without bias
    /// by track length: each stretch of the flight adds radiance per metre, at a point of it drawn
    /// by chance, times its length and the weight of flights that come so far.
    glm::vec3 emitted{0};
};

/// Samples the flight of a path with throughput `beta` (>= 0, not all 0) over at most `reach` [m].
/// Delta tracking [Woodcock1965] against bounds of the density that differ from cell to cell.
/// Extinctions of one volume differ by channel, but the share of its collisions that are with
/// nothing does not; so one channel, drawn in proportion to the throughput, decides each flight to
/// a possible collision, and the weight divides by the mean density of all three (balance
/// heuristic): the sum of the throughput's channels never grows. `gathers_glow`: whether `emitted`
/// is wanted; without it it is 0.
VolumeFlight sample_volume_flight(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction,
                                  float reach, glm::vec3 beta, RandomStream& random,
                                  bool gathers_glow = false);

/// Transmittance of a straight line of `reach` [m], an estimate without bias by ratio tracking
/// [Novak2014]: the share that is left at each possible collision with the densest channel. Each
/// in [0, 1] until Russian roulette below 0.1 lets few lines go on for the rest.
glm::vec3 estimate_transmittance(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction,
                                 float reach, RandomStream& random);

}  // namespace opaline::bake
