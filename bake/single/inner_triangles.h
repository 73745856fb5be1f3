#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/visibility/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Which triangles of a material lie inside its medium, where another of its shells is around them,
/// and so are no boundary (README.md, "Signed depth"); in the order of the
/// scene's primitives. Judged in four points of each triangle, along three rays each: one that
/// is only partly inside, or about which the rays disagree, as they do near holes, counts as
/// boundary. 1: inside. All zero if the context is cancelled.
std::vector<std::uint8_t> find_inner_triangles(const formats::Scene& scene, const RayScene& rays,
                                               std::uint32_t material, const Context& context);

}  // namespace opaline::bake
