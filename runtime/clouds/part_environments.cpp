#include "runtime/clouds/part_environments.h"

#include "runtime/clouds/environment_at.h"
#include "runtime/specular.h"

namespace opaline::runtime {

PartEnvironments environments_of_parts(const LayerScene& scene, const formats::AssetView& asset,
                                       std::span<const formats::Vec3> volume_corners,
                                       formats::Vec3 centre, unsigned threads) {
    PartEnvironments parts;
    parts.points = light_points(asset, volume_corners, scene.light.field, centre);
    parts.at_point.reserve(parts.points.point.size());
    for (const formats::Vec3 point : parts.points.point) {
        parts.at_point.push_back(environment_at(scene, point, {.threads = threads}));
    }
    if (parts.at_point.size() > 1 && specular_needs(asset).any()) {
        parts.at_centre = environment_at(scene, centre, {.threads = threads});
    }
    return parts;
}

}  // namespace opaline::runtime
