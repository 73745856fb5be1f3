#pragma once

#include <glm/glm.hpp>

#include "bake/reference/hit_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The unit normal that a point of a surface is shaded with, on the side of its triangle's: the
/// interpolated one, or what its material's normal map makes of that one. A map's normal beyond the
/// triangle's horizon is lifted above it, to a cosine of 0.01 or more.
glm::vec3 shading_normal(const formats::Scene& scene, const SurfaceHit& hit);

}  // namespace opaline::bake
