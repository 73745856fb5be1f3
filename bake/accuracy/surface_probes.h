#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/accuracy/check_point.h"
#include "bake/base/context.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

struct ProbeOptions {
    std::size_t count = 0;  ///< how many are drawn
    std::uint64_t seed = 0;
    std::uint32_t first_key = 0;  ///< CheckPoint::key of the first
};

/// Random points of the surface, uniform by area over the scene's `primitives`, one in each of
/// `count` parts of equal area. They lie on the triangles; their normals are interpolated, and
/// their rays start where the smooth surface would be (surface_samples.h). Points that
/// hidden_receivers.h calls hidden are left out.
std::vector<CheckPoint> draw_surface_probes(const formats::Scene& scene, const RayScene& rays,
                                            const std::vector<std::uint32_t>& primitives,
                                            const ProbeOptions& options, const Context& context);

}  // namespace opaline::bake
