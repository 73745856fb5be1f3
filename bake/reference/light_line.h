#pragma once

#include <glm/glm.hpp>

#include "bake/reference/path.h"

namespace opaline::bake {

/// Straight lines from an event of a path to light; private to the walk.

/// A line to the sky, to a place, or to a triangle.
struct LightLine {
    RayOrigin from;
    glm::vec3 direction{0};  ///< unit
    float reach = 0;         ///< [m] to the place; infinite: out of the scene, or to the triangle
    std::uint32_t primitive = formats::kNone, triangle = formats::kNone;  ///< where it ends
    std::uint32_t key = 0;                                                ///< HitScene::closest_hit
    bool is_to_sky = false;  ///< nothing passes if the path would end in no requested term
};

/// What passes along a line, an estimate without bias. 0 if anything but a boundary between equal
/// indices is in the way, or if a line out of the scene ends in a body. `stack` becomes that at its
/// end.
glm::vec3 pass_line(const PathSpace& space, LightLine line, SurroundingMedia& stack,
                    PathState state, RandomStream& random);

/// Of a straight line to the sky.
glm::vec3 see_sky(const PathSpace& space, const RayOrigin& from, glm::vec3 direction,
                  SurroundingMedia stack, PathState state, std::uint32_t key, RandomStream& random);

/// Radiance per squared index, as paths carry it, of a radiance inside the bodies of `stack`.
float per_squared_index(const ReferenceScene& scene, const SurroundingMedia& stack);

}  // namespace opaline::bake
