#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

/// Irradiance [lx] at a point with unit normal from a triangle of radiance 1 nit, nothing between:
/// the part above the horizon, by the sum over its edges [Lambert1760]. 0 from behind it unless it
/// has two sides.
double triangle_irradiance(const GlowingTriangle& triangle, const glm::dvec3& point,
                           const glm::dvec3& normal);

/// Irradiance [lx] that comes from a lamp straight to a receiver.
///
/// Triangles, textured ones as parts that are small beside their distance: exact unoccluded
/// irradiance, times the mean visibility of `samples` points, spread
/// over them in proportion to it: without noise where nothing or all is hidden. Lights: one shadow
/// ray each. Light of voxels: glow_light.h. `volumes` dim all; null: none. `rays` counts those
/// traced. `first`: so many points of the sequence are left out, for an estimate by others.
glm::dvec3 straight_irradiance(const RayScene& scene, const LampSources& lamp,
                               const Receiver& receiver, std::uint32_t samples, std::uint64_t& rays,
                               const DensitySpace* volumes = nullptr, std::uint32_t first = 0);

}  // namespace opaline::bake
