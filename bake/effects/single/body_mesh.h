#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The boundary of a medium and everything else in a scene as one list of triangles, the boundary
/// first. Triangles within the medium are left out.
struct BodyMesh {
    std::vector<glm::vec3> position;   ///< [m], relative to `centre`
    std::vector<glm::uvec3> triangle;  ///< outward counter-clockwise
    std::uint32_t body_triangles = 0;  ///< of the medium; the rest only blocks light
    glm::vec3 centre{0};               ///< of the body's bounding box [m]
    float radius = 0;                  ///< [m] of a sphere around `centre` that holds the body
    float mean_edge = 0;               ///< [m] of the body's triangles
};

BodyMesh make_body_mesh(const formats::Scene& scene, const RayScene& rays, std::uint32_t material,
                        const Context& context);

}  // namespace opaline::bake
