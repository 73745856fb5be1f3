#pragma once

#include <glm/glm.hpp>

#include "bake/emitters/surface_elements.h"
#include "bake/scene/texture_pyramid.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a surface does to light that arrives at a point of one of its sides, both diffusely.
struct BounceColor {
    glm::dvec3 reflect{0};   ///< to the side that it came from, in [0, 1]
    glm::dvec3 transmit{0};  ///< to the other side: of thin-walled surfaces
};

/// At a point of a triangle, `weights` barycentric. What is mirrored does not count (onward_ray.h).
/// Black for media, whose light is in media_light.h, and for backs of single-sided surfaces.
/// `view`: footprint of texture look-ups; null: at the point.
BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights, const TextureView* view = nullptr);

/// The metal that a point of an opaque surface is made of: base color, how much of it is metal in
/// [0, 1], GGX alpha. None of media, thin walls and backs of single-sided surfaces.
struct MetalPart {
    glm::dvec3 color{0};
    double metallic = 0, alpha = 1;
};
MetalPart metal_part(const formats::Scene& scene, const TriangleSide& side,
                     const glm::vec3& weights);

/// The base color's image there, white without one.
glm::vec3 base_image_color(const formats::Scene& scene, const TriangleSide& side,
                           const glm::vec3& weights, const TextureView* view = nullptr);

}  // namespace opaline::bake
