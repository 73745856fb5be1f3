#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace opaline::bake {

/// A point at which light is gathered, as the ray tracer needs it.
struct Receiver {
    glm::vec3 origin;  ///< [m], where rays start: in front of every triangle that touches the point
    glm::vec3 normal;  ///< unit shading normal; {0,0,0}: no normal exists, nothing is gathered
};

/// A point of a uniformly distributed set on the surface; the areas of a set add up to the surface.
struct SurfaceSample {
    glm::vec3 position;           ///< [m], on the triangle
    glm::vec3 geometric_normal;   ///< unit
    glm::vec3 normal;             ///< unit, interpolated; within the geometric normal's hemisphere
    float area = 0;               ///< [m^2]
    std::uint32_t primitive = 0;  ///< index into Scene::primitives
    Receiver receiver;            ///< rays from here see the terminator of the smooth surface
};

}  // namespace opaline::bake
