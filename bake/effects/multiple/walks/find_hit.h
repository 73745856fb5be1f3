#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/walk_space.h"

namespace opaline::bake {

/// Distance [m] to the nearest triangle, or `reach` [m] if that is less; smaller by a bound on
/// rounding. Triangles without an area do not count.
float find_clearance(const WalkSpace& space, glm::vec3 position, float reach);

/// Where a straight flight meets a triangle.
struct WalkHit {
    glm::vec3 position{0};  ///< [m]
    glm::vec3 flat{0};      ///< unit normal of the triangle, outward by its winding
    float error = 0;        ///< bound [m] on the distance of `position` from the triangle
    bool is_own = false;    ///< of the space's material
    std::uint8_t medium = kNoWalkMedium;           ///< of its body: WalkSpace::medium_of
    std::uint16_t place = 0;                       ///< of its material: WalkSpace::place_of
    std::uint32_t primitive = 0, first_index = 0;  ///< of its triangle: Primitive::index
    float u = 0, v = 0;                            ///< weights of its second and third corner
};

/// The first triangle within `reach` [m]. False: there is none, and `hit` is not defined.
bool find_hit(const WalkSpace& space, glm::vec3 origin, glm::vec3 direction, float reach,
              WalkHit& hit);

/// The same of several flights from one point, to any distance; none where there is no triangle.
std::vector<std::optional<WalkHit>> find_hits(const WalkSpace& space, glm::vec3 origin,
                                              std::span<const glm::vec3> directions);

/// For each of `to` 1 if no triangle lies between it and `from`, but for the last thousandth of the
/// way, else 0. Overwrites `seen`.
void find_seen(const WalkSpace& space, glm::vec3 from, std::span<const glm::vec3> to,
               std::vector<std::uint8_t>& seen);

/// Whether a corner of the hit triangle lies at `vertex`, exactly.
bool is_around_vertex(const WalkSpace& space, const WalkHit& hit, glm::vec3 vertex);

/// The interpolated normal, unit; the triangle's own where that faces away from it.
glm::vec3 smooth_normal(const WalkSpace& space, const WalkHit& hit);

/// The normal at which a boundary reflects what arrives from inside along `direction`: the smooth
/// one, unless it faces away or reflects to behind the triangle; then the triangle's own.
glm::vec3 inner_boundary_normal(const WalkSpace& space, const WalkHit& hit, glm::vec3 direction);

}  // namespace opaline::bake
