#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/openness.h"

namespace opaline::bake {

/// Cube map over which openness is measured for mirror reflection.
inline constexpr std::uint32_t kOpennessCubemap = 8;

/// The open part of a receiver's hemisphere H, with V the visibility:
///     fraction = 1/pi int_H V (n.w) dw,    axis = direction of int_H V (n.w) w dw,
/// both over the rays of `directions`, so that an unoccluded receiver has fraction 1 exactly. A
/// fully blocked receiver has fraction 0 and its normal as axis; a receiver without a normal has
/// fraction 0 and +Z.
struct OpenHemisphere {
    glm::vec3 axis{0, 0, 1};  ///< unit
    float fraction = 0;
    std::uint64_t rays = 0;  ///< traced
};
/// For up to sixteen receivers, fast if they are neighbours. `seen`: one entry for each.
void gather_openness(const RayScene& rays, const DirectionSet& directions,
                     std::span<const Receiver> receivers, std::span<OpenHemisphere> seen);

/// Openness of each receiver, in order; fewer if the context is cancelled. A sparse direction set
/// of N = 8 (192 rays per hemisphere) matches the precision of the four stored bytes. The same for
/// any number of threads. Adds to `traced`.
std::vector<formats::Openness> bake_openness(const RayScene& rays, const DirectionSet& directions,
                                             std::span<const Receiver> receivers,
                                             const Context& context, std::uint64_t& traced);

}  // namespace opaline::bake
