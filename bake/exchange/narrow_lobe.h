#pragma once

#include <array>
#include <glm/glm.hpp>

#include "bake/exchange/bounce_rays.h"
#include "formats/opal/gloss_model.h"

namespace opaline::bake {

/// Where a ray that a lobe mirrors goes on, unit, in the frame whose third axis is the normal of
/// the lobe: one of four, stratified by `u` over the facets that the ray sees [Heitz2018], drawn in
/// proportion to F G2 / G1 of each [Talbot2005]. So all of what the lobe mirrors, its directional
/// albedo, goes one way, and no ray has more than that. About the normal itself where all four end
/// below the surface. `to_eye`: unit, above the horizon. `flat`: the facet's normal, below which
/// nothing is mirrored; the result is zero where all that is left is there.
glm::dvec3 sample_narrow_lobe(const formats::GlossSurface& lobe, const glm::dvec3& to_eye,
                              const glm::dvec3& flat, const std::array<float, 4>& u);

/// mirror() of opaque and thin-walled surfaces, about the interpolated normal. Precondition: the
/// side is seen.
MirroredRay mirror_by_lobe(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                           std::uint32_t number);

}  // namespace opaline::bake
