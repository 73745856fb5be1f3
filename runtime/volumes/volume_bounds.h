#pragma once

#include <cstddef>
#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"

namespace opaline::runtime {

/// Corners [m, world] of the smallest box around the density of each volume and its own light, in
/// its own axes: eight for each volume that has any. May be infinite where a transform is.
std::vector<formats::Vec3> volume_corners(const formats::VolumesView& volumes);

/// The same of one volume.
std::vector<formats::Vec3> volume_corners(const formats::VolumesView& volumes, std::size_t volume);

}  // namespace opaline::runtime
