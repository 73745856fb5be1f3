#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// A part of the outline of what a receiver sees against the sky.
struct SkyOutline {
    float weight = 0;    ///< squared cosine times solid angle, over 2 pi / 3
    float distance = 0;  ///< of what ends there [m]
};

/// The outlines between neighbouring cells of a cube map, one ray a cell.
std::vector<SkyOutline> find_outlines(const RayScene& rays, const DirectionSet& directions,
                                      const Receiver& receiver, std::uint64_t& traced);

/// How far apart [m] receivers may lie where those see `outlines`, for interpolation between them
/// to err by `square` in the mean square over suns, relative to an open receiver's. Light of a cell
/// comes from `angle` [rad]: an edge at distance d casts a shadow whose border is angle d wide,
/// across which irradiance rises as a ramp. Interpolated over a length l = s angle d its square
/// errs by s^3 / 50, the two ends of the ramp cut off, until a shadow has an edge: by 1 / 12 at
/// most. Infinity where any distance will do.
float spacing_for(std::span<const SkyOutline> outlines, double angle, double square);

}  // namespace opaline::bake
