#pragma once

#include <cstdint>

#include "bake/exchange/bounce_rays.h"

namespace opaline::bake {

/// Whether a ray has met the boundary of a medium from inside. Not where walks go through several
/// media as one space: these bring their own light there.
bool is_inside(const BounceSpace& space, const RayEnd& end);

/// Events of one ray inside media that are followed; in denser ones the rest of its light is lost.
inline constexpr std::uint32_t kMostInside = 1024;

/// How the ray goes on: a scattering before the boundary, refracted out of it, or reflected. With
/// `share` of the first ray's radiance over index squared, less what the medium absorbs on the way.
/// Light scatters alike in all directions, with (1 - g) sigma_s (similarity [Wyman1989]); the
/// boundary is smooth, and flat in each triangle. By chance, drawn by the ray's place, direction
/// and `seed`. Precondition: is_inside.
MirroredRay go_on_inside(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                         std::uint32_t number, std::uint64_t seed = 0);

}  // namespace opaline::bake
