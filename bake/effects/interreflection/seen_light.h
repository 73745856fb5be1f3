#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/interreflection/bounce_light.h"
#include "bake/transport/other_light.h"

namespace opaline::bake {

/// What answers a view.
struct SeenNode {
    std::uint32_t node = 0;
    std::uint32_t view = 0;  ///< its number
    float share = 1;         ///< of the view's light: less of what boundaries of media mirror
};

/// For each view the node of its surface that is as large as the view's footprint, by nodes. Views
/// that meet no radiating surface have none. Views that meet a medium have more, for the light
/// that its boundary mirrors. `traced` counts up.
std::vector<SeenNode> find_seen(const formats::Scene& scene, const RayScene& rays,
                                const BounceTree& tree, std::span<const SurfaceView> views,
                                double solid_angle, std::uint64_t& traced);

/// Adds the radiance that views see of other surfaces, as OtherLight::add_seen: radiosity over pi
/// of the clusters as large as each view's footprint, the same in all directions. Returns the rays
/// traced.
std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows);

}  // namespace opaline::bake
