#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/interreflection/bounce_tree.h"
#include "bake/effects/interreflection/scatterers.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A ray that meets a surface.
struct RayEnd {
    glm::vec3 position{0}, direction{0};  ///< [m]; unit, of the ray
    float error = 0;                      ///< bound [m] on that of the position
    std::uint32_t material = 0;
    SeenSide side;
};

/// What the boundary of a medium mirrors of a ray's light, as one direction of its lobe.
struct MirroredRay {
    glm::vec3 origin{0}, direction{0};  ///< [m]; unit
    float share = 0;                    ///< of the first ray's; 0: nothing is mirrored
    std::uint32_t number = 0;           ///< of the first ray
};

/// By the Fresnel reflectance of its angle, about the facet's normal; of a rough boundary about one
/// of the normals that the ray sees, GGX [Heitz2018], drawn by the ray's place and direction.
/// Materials other than media mirror nothing here: their mirrored light is part of their radiosity
/// (eval_surface_albedo).
MirroredRay mirror(const formats::Scene& scene, const RayEnd& end, float share,
                   std::uint32_t number);

/// The node that answers a mirrored ray: of a surface, or of the sky.
struct MirroredNode {
    std::uint32_t node = 0;
    float share = 0;  ///< of the first ray's light
    std::uint32_t number = 0;
};

/// Follows mirrored rays from medium to medium until they carry little light, and appends their
/// hits to `found`. Returns the rays traced.
std::uint64_t follow_mirrored(const formats::Scene& scene, const RayScene& rays,
                              const BounceTree& tree, std::vector<MirroredRay> open,
                              std::vector<MirroredNode>& found);

}  // namespace opaline::bake
