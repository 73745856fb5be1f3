#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Marks the triangles of a material that lie inside another shell of its medium and so are no
/// boundary (README.md, "Signed depth"); in the order of the scene's primitives. Tested at four
/// points of each triangle, along three rays each. A triangle that is only partly inside, or on
/// which the rays disagree (near holes), counts as boundary. 1: inside. All zero if the context is
/// cancelled.
std::vector<std::uint8_t> find_inner_triangles(const formats::Scene& scene, const RayScene& rays,
                                               std::uint32_t material, const Context& context);

}  // namespace opaline::bake
