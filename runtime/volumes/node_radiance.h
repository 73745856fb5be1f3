#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::runtime {

/// max(0, J) of every node of a volume toward the point `eye` [m, world]; without one the mean of J
/// over all directions, likewise not below 0. T counts as 1: as near the node.
std::vector<formats::Rgb> node_radiance(const formats::VolumesView& volumes,
                                        const VolumeLight& light, std::size_t volume,
                                        const std::optional<formats::Vec3>& eye);

}  // namespace opaline::runtime
