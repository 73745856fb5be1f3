#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "bake/reference/hit_scene.h"
#include "bake/reference/phase_sampler.h"
#include "bake/reference/random_stream.h"
#include "bake/reference/volume_space.h"
#include "bake/scene/medium_field.h"

namespace opaline::bake {

/// A medium as the walk needs it [1/m]: homogeneous, or with less than that where its field says
/// so.
struct ReferenceMedium {
    glm::vec3 sigma_s{0}, sigma_t{0};
    std::optional<MediumField> field;
    float eta = 1;             ///< index of refraction relative to the outside of everything
    float boundary_alpha = 0;  ///< GGX width of its surface's facets; 0: smooth
    PhaseSampler phase;

    /// Extinction is equal in all channels, so no channel need be drawn.
    bool is_grey() const { return sigma_t.x == sigma_t.y && sigma_t.y == sigma_t.z; }
};

/// A free flight and the event that ended it.
struct Flight {
    /// the surface that ended the flight; nothing: a scattering event
    std::optional<SurfaceHit> surface;
    float distance = 0;   ///< [m]; infinite: the path escapes without an event
    glm::vec3 weight{1};  ///< contribution over density, scattering coefficient included
};

/// One of three channels, with probabilities that sum to 1.
inline int draw_channel(glm::vec3 odds, float u) {
    const int channel = u < odds.x ? 0 : u < odds.x + odds.y || odds.z <= 0 ? 1 : 2;
    // Rounding may select a channel of probability 0: take the last one above 0.
    return odds[channel] > 0 ? channel : odds.y > 0 ? 1 : 0;
}

/// Samples the free flight of a path with throughput `beta` (not all 0) through a medium. One
/// channel, drawn in proportion to beta, decides the distance. The weight divides by the mean
/// density of all three with the same probabilities (balance heuristic), so the sum of the
/// throughput's channels never grows. `find_surface(t)` returns the first surface if it is nearer
/// than t [m]; farther ones count as none.
template <class FindSurface>
Flight sample_flight(const ReferenceMedium& medium, glm::vec3 beta, RandomStream& random,
                     FindSurface&& find_surface) {
    const bool is_grey = medium.is_grey();
    const glm::vec3 odds = beta / (beta.x + beta.y + beta.z);
    const float sigma = medium.sigma_t[is_grey ? 0 : draw_channel(odds, random.next())];
    // 1 - u is exact: u has 24 bits.
    const float free =
        sigma > 0 ? -std::log(1 - random.next()) / sigma : std::numeric_limits<float>::infinity();
    Flight flight;
    flight.surface = find_surface(free);
    if (flight.surface && flight.surface->distance > free) {
        flight.surface.reset();
    }
    flight.distance = flight.surface ? flight.surface->distance : free;
    if (std::isinf(flight.distance)) return flight;
    if (is_grey) {
        flight.weight = flight.surface ? glm::vec3(1) : medium.sigma_s / sigma;
        return flight;
    }
    // Relative to the chosen channel, so that the density neither underflows nor overflows.
    const glm::vec3 excess = (medium.sigma_t - sigma) * flight.distance;
    const glm::vec3 passing = glm::exp(-excess);
    if (flight.surface) {
        flight.weight = passing / glm::dot(odds, passing);
    } else {
        flight.weight = medium.sigma_s * passing / glm::dot(odds, medium.sigma_t * passing);
    }
    return flight;
}

/// The same through a medium that varies, by delta tracking [Woodcock1965]: collisions with
/// the stated extinction, of which the share 1 - density is with nothing, so that the flight goes
/// on. That share is the same in all channels: what the weight holds of it cancels.
template <class FindSurface>
Flight sample_varied_flight(const ReferenceMedium& medium, glm::vec3 from, glm::vec3 direction,
                            glm::vec3 beta, RandomStream& random, FindSurface&& find_surface) {
    const MediumField& field = *medium.field;
    ReferenceMedium dense;
    dense.sigma_s = dense.sigma_t = medium.sigma_t;  // of a collision, whatever it is with
    glm::vec3 weight(1);
    float way = 0;
    for (;;) {
        Flight step = sample_flight(dense, beta * weight, random,
                                    [&](float free) -> std::optional<SurfaceHit> {
                                        auto hit = find_surface(way + free);
                                        if (hit) {
                                            hit->distance = std::max(0.0f, hit->distance - way);
                                        }
                                        return hit;
                                    });
        weight *= step.weight;
        const float done = way;
        way += step.distance;
        if (step.surface) {
            step.surface->distance += done;
        }
        const glm::vec3 at = from + way * direction;
        const bool collides = !step.surface && !std::isinf(way);
        const bool is_null =
            collides && field.has_density() && !(random.next() < field.density(at));
        if (!is_null || !(glm::dot(beta, weight) > 0)) {
            step.distance = way;
            step.weight = collides ? weight * field.albedo(at) : weight;
            return step;
        }
    }
}

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
