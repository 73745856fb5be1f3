#pragma once

#include <cstdint>

#include "bake/exchange/bounce_rays.h"
#include "bake/receivers/receiver.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether a ray meets the boundary of a medium from inside. Not where walks go through several
/// media as one space: these bring their own light there.
bool is_inside(const BounceSpace& space, std::uint32_t material, const SeenSide& side);

/// The medium that a surface lies in, as rays from it say that meet such a boundary from inside.
struct MediumAround {
    std::uint32_t material = formats::kNone;  ///< none
    /// No boundary is nearer than 32 mean free paths (similarity): nobody sees light from there,
    /// and none is followed.
    bool is_deep = false;
};
MediumAround medium_around(const BounceSpace& space, const Receiver& at);

/// Whether light changes on its way through the medium: it is scattered or absorbed.
bool changes_light(const formats::Medium& medium);

/// Events of one ray inside media that are followed; in denser ones the rest of its light is lost.
inline constexpr std::uint32_t kMostInside = 1024;

/// Takes a ray on where it is in a medium before it has met `end`, or meets a boundary from inside:
/// it is scattered before, refracted out there, or reflected, by chance, which the ray's place,
/// direction and `seed` draw. Light scatters alike in all directions, with (1 - g) sigma_s
/// (similarity [Wyman1989]); the boundary is smooth, and flat in each triangle. The share is that
/// of the first ray's radiance over index squared.
/// False: it arrives at `end`, with what the medium leaves of it.
bool go_on_inside(const BounceSpace& space, const RayEnd& end, MirroredRay& ray,
                  std::uint64_t seed = 0);

}  // namespace opaline::bake
