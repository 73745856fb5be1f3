#pragma once

#include <optional>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/clouds/light_points.h"
#include "runtime/clouds/see_layer.h"

namespace opaline::runtime {

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
