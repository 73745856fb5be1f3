#pragma once

#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"

namespace opaline::runtime {

/// Corners [m, world] of the smallest box around the density of each volume, in its own axes: eight
/// for each volume that has any. May be infinite where a transform is.
std::vector<formats::Vec3> volume_corners(const formats::VolumesView& volumes);

}  // namespace opaline::runtime
