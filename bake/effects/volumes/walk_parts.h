#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "bake/base/rng.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/density/scaled_phase.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// What random walks from nodes have in common, whatever light they look for.

/// A walk ends after so many scatterings. Only media thousands of mean free paths deep reach this,
/// where the remaining light is negligible.
inline constexpr std::uint32_t kMostScatterings = 2048;

/// Weight below which a walk may end by chance; those that go on have this weight.
inline constexpr float kWalkRoulette = 0.25f;

/// Uniform numbers of one walk, in order.
class FlightRandom {
  public:
    FlightRandom(std::uint64_t seed, RandomStage stage, std::uint64_t walk)
        : seed_(seed), walk_(walk), stage_(stage) {}

    /// In [0, 1).
    float operator()() {
        if (used_ == number_.size()) {
            number_ = random_uniform(seed_, stage_, walk_, draw_++);
            used_ = 0;
        }
        return number_[used_++];
    }

    /// Goes on with the numbers that belong to an event of the walk, whatever was drawn before.
    void begin_event(std::uint32_t event) {
        constexpr std::uint32_t kMostDraws = 1 << 16;
        draw_ = event * kMostDraws;
        used_ = number_.size();
    }

  private:
    std::uint64_t seed_, walk_;
    RandomStage stage_;
    std::uint32_t draw_ = 0;
    std::size_t used_ = 4;
    std::array<float, 4> number_{};
};

/// Unit direction i of `count` that cover the sphere evenly, turned by two numbers in [0, 1).
glm::vec3 even_direction(std::uint32_t i, std::uint32_t count, float u, float v);

/// Bands [first, end) that follow the extinction of `first`.
struct WalkTrack {
    std::size_t first = 0, end = 3;
};

/// Walks from a node of a volume.
struct NodeWalks {
    std::uint64_t seed = 0;
    RandomStage stage{};
    std::size_t node = 0;     ///< the random numbers depend on it
    std::uint32_t count = 0;  ///< of walks
    std::size_t bands = 3;    ///< of light; with one extinction a walk follows all of them
};

/// Follows walks that leave a node in directions which cover the sphere evenly. Of each walk, sets
/// `sum` to zero, calls follow(track, direction, random), which adds to it and returns the rays
/// traced, once for every track of `space`, and take(walk, direction). Tracks of a walk share its
/// numbers, so that its noise has no colour. Returns the rays traced.
template <class Light, class Follow, class Take>
std::uint64_t walk_from_node(const DensitySpace& space, const NodeWalks& walks,
                             std::vector<Light>& sum, Follow&& follow, Take&& take) {
    std::vector<WalkTrack> tracks{{0, walks.bands}};
    if (!space.is_grey) {
        tracks = {{0, 1}, {1, 2}, {2, 3}};
    }
    std::uint64_t traced = 0;
    FlightRandom shift(walks.seed, walks.stage, walks.node);
    const float u = shift(), v = shift();
    for (std::uint32_t i = 0; i < walks.count; ++i) {
        const glm::vec3 direction = even_direction(i, walks.count, u, v);
        std::ranges::fill(sum, Light(0));
        for (const WalkTrack& track : tracks) {
            FlightRandom random(walks.seed, walks.stage,
                                (std::uint64_t{i} + 1) << 40 | std::uint64_t{walks.node});
            traced += follow(track, direction, random);
        }
        take(i, direction);
    }
    return traced;
}

/// The first surface that a walk meets.
struct MetSurface {
    float distance = std::numeric_limits<float>::infinity();  ///< [m]; without one infinite
    std::uint32_t material = 0;
    glm::vec3 normal{0};  ///< unit, of its facet as it is wound; zero: it has none
    float cosine = 0;     ///< of the ray with that

    bool is_there() const { return distance < std::numeric_limits<float>::infinity(); }
};

/// Counts rays in `traced`.
MetSurface find_surface(const RayScene& rays, glm::vec3 from, glm::vec3 direction,
                        std::uint64_t& traced);

/// Multiplies the weights of the bands [first, end) by the albedo of a collision. False: the walk
/// ends there by chance.
bool survives(const std::array<float, 3>& albedo, std::size_t first, std::size_t end,
              std::array<float, 3>& weight, FlightRandom& random);

/// Coefficient k of J, by harmonics, over that of the incident radiance: (-1)^l lambda'_l.
float scattered_harmonic(const ScaledPhase& phase, std::uint32_t k);

struct WalkCount {
    double flights = 0, collisions = 0;
};

/// A walk in green light from a point, as gather_walks follows it, without the light that joins it.
WalkCount count_walk(const DensitySpace& space, glm::vec3 at, FlightRandom& random);

/// Unit, uniform over the sphere.
glm::vec3 draw_direction(FlightRandom& random);

/// Turns a unit direction by the phase function; two random numbers.
SampledCosine turn_walk(const ScaledPhase& phase, glm::vec3& direction, FlightRandom& random);

}  // namespace opaline::bake
