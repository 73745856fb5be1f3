#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/trace/cross_bodies.h"

namespace opaline::bake {

/// The direction of a walk's first flight, into the half space below both normals of its start,
/// with density F_t(c) c over the outer hemisphere, refracted by the smooth normal; where that
/// leads above the facet, by the facet's.
glm::vec3 start_direction(const WalkSpace& space, const WalkStart& start, WalkRandom& random);

/// What lies beyond a surface that a walk has met after a flight from `from` [m], `way` [m] long.
/// `bodies`: around the flight. `rays` counts up.
FarSide find_far_side(const WalkSpace& space, const MediumStack& bodies, glm::vec3 from,
                      glm::vec3 direction, float way, const WalkHit& hit, std::uint64_t& rays);

/// What a surface of no medium makes of a walk that meets it.
struct WalkReflection {
    glm::vec3 normal{0};            ///< unit: diffuse light goes on into its half space
    std::array<float, 3> albedo{};  ///< of light that does
};
/// Opaque surfaces reflect their base colour, as if diffuse; thin walls reflect or transmit it,
/// which `u` draws, uniform in [0, 1). In grey spaces the mean of the bands. None: it is black from
/// that side, or bounds a medium that the space does not hold.
std::optional<WalkReflection> reflect_at(const WalkSpace& space, const WalkHit& hit,
                                         glm::vec3 direction, float u);

}  // namespace opaline::bake
