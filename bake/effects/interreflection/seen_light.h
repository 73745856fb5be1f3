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

/// The node of each view's surface that is as large as what the view stands for, by nodes. Views
/// that meet no surface that sends light have none; those that meet a medium have others besides,
/// for what its boundary mirrors. `traced` counts up.
std::vector<SeenNode> find_seen(const formats::Scene& scene, const RayScene& rays,
                                const BounceTree& tree, std::span<const SurfaceView> views,
                                double solid_angle, std::uint64_t& traced);

/// Adds what views see of other surfaces, as of OtherLight::add_seen: radiosity over pi of the
/// clusters as large as what each view stands for. Their light counts as the same in all
/// directions. Returns the rays traced.
std::uint64_t add_seen_light(const BounceLight& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint32_t cubemap_size, std::uint32_t bands,
                             std::span<float> rows);

}  // namespace opaline::bake
