#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "bake/reference/boundary.h"
#include "bake/reference/path.h"

namespace opaline::bake {

/// Events of a path at surfaces and in media; private to the walk.

/// A path from the eye, up to its current vertex.
struct Path {
    RayOrigin origin;
    glm::vec3 direction{0};
    glm::vec3 beta{1};  ///< throughput
    MediumStack stack;
    PathState state;
    std::uint32_t events = 0;
    /// [1/sr] of `direction` if the light was sampled at the last event too; else 0
    float pdf = 0;
    glm::vec3 radiance{0};
    bool lost = false;
};

/// Two sides of a boundary that a path has arrived at.
struct Crossing {
    BoundarySplit split;
    RayOrigin near, far;  ///< where rays start on this side and beyond
    MediumStack beyond;   ///< bodies on the far side
    glm::vec3 color{1};   ///< factor of light that enters a body
};

/// True if the path may still end in a term that is counted.
inline bool is_wanted(const PathSpace& space, PathState state) {
    return has_any(reachable_terms(state), space.options.terms);
}

/// A diffuse surface. Normals face the path; `flat` may be {0,0,0} at a vertex, which lies on
/// several triangles. False: the path ends.
bool reflect_diffusely(const PathSpace& space, Path& path, const RayOrigin& from, glm::vec3 normal,
                       glm::vec3 flat, glm::vec3 albedo, RandomStream& random);

/// The path continues beyond the boundary in the same direction.
void pass_boundary(Path& path, const Crossing& crossing);

/// A boundary between different indices. The path is reflected or transmitted at random, or always
/// takes one side if the other leads to no requested term. False: the path ends.
bool reflect_or_refract(const PathSpace& space, Path& path, const Crossing& crossing,
                        RandomStream& random);

/// A scattering event at a point of the medium around. False: the path ends.
bool scatter(const PathSpace& space, Path& path, glm::vec3 at, RandomStream& random);

}  // namespace opaline::bake
