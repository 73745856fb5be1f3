#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"
#include "runtime/clouds/see_layer.h"

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

/// What lights the meshes and volumes of an asset beneath or above its layer (environment_at.h).
struct PartEnvironments {
    LightPoints points;                          ///< where they are lit
    std::vector<formats::Environment> at_point;  ///< at each of these; one at least
    /// At the centre of all, where parts with points of their own mirror something.
    std::optional<formats::Environment> at_centre;

    /// What surfaces mirror, if they do.
    const formats::Environment& mirrored() const { return at_centre ? *at_centre : at_point[0]; }
};

/// `centre` [m] is that of all meshes and volumes, `volume_corners` as light_points has them.
/// `threads` 0: all cores; the result has the same bits for any number. Precondition: the asset has
/// a mesh or a volume.
PartEnvironments environments_of_parts(const LayerScene& scene, const formats::AssetView& asset,
                                       std::span<const formats::Vec3> volume_corners,
                                       formats::Vec3 centre, unsigned threads = 0);

}  // namespace opaline::runtime
