#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"

namespace opaline::runtime {

/// Where the parts of an asset are lit (environment_at.h): a point for each group of nodes.
struct LightPoints {
    std::vector<formats::Vec3> point;         ///< [m], world; at least one
    std::vector<std::uint32_t> of_primitive;  ///< index of its point
    std::uint32_t of_volumes = 0;             ///< of all volumes
};

/// One point, `centre`, for all that stands within a texel of the layer's thickness, and beneath an
/// endless layer that is even. Else nodes, by the centres of their boxes, and the volumes together
/// fall into square cells along x and z, of the least side texel 2^k that leaves kMaxLightPoints at
/// most; each has the centre of the box around what is in it. A node of the scene is never divided.
/// `volume_corners`: of boxes around the volumes (volumes/volume_bounds.h). Precondition: the asset
/// passed read_opal's checks.
LightPoints light_points(const formats::AssetView& asset,
                         std::span<const formats::Vec3> volume_corners, const LayerField& field,
                         formats::Vec3 centre);
inline constexpr std::size_t kMaxLightPoints = 16;

}  // namespace opaline::runtime
