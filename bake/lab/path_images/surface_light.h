#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "bake/lab/path_images/scattered_light.h"
#include "bake/reference/hit_scene.h"

namespace opaline::bake {

/// The first opaque surface that a camera sees along a ray; single-sided ones are not seen from
/// behind.
std::optional<SurfaceHit> first_visible_hit(const HitScene& surfaces, glm::vec3 origin,
                                            glm::vec3 direction);

/// Radiance [W m^-2 sr^-1] that a surface reflects diffusely, or a thin one transmits, of light
/// that no other surface stops and volumes dim. `direction`: unit, of the view ray. The sky's cells
/// are visible or not as a whole.
glm::dvec3 reflect_diffusely_once(const ScatteringSpace& space, const HitScene& surfaces,
                                  const SurfaceHit& hit, glm::vec3 direction);

}  // namespace opaline::bake
