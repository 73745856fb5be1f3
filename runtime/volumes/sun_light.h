#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::runtime {

/// Light of suns at the points of volumes, and the part that they scatter: fills
/// sun_coefficients(v, b, p) of all bricks and points of volumes that have suns. Point (i, j, k) of
/// a brick lies i, j, k times 8 / sun_boxes voxels from its voxel (0, 0, 0). There
///
///     V_s = min(e^-tau, 2 U_s),   tau = sum over volumes of int sigma_t density ds toward the sun
///
/// (sun_columns.h). U_s, from the rows, is coarse: means over four texels, linear between nodes.
/// But only rows hold the shadows of surfaces, where U_s is near 0, and in coloured rows (bands =
/// 3) hues of the albedo: there V_s = min(e^-tau, U_s). Coefficients are lowered, because linear
/// interpolation between points is too bright (find_lowering). `reach`: of each volume U_s at
/// nodes, share[node * suns + s], not below 0. The same bits for any number of threads.
void light_sun_points(const formats::VolumesView& volumes,
                      std::span<const std::vector<formats::Rgb>> reach, unsigned threads,
                      VolumeLight& light);

}  // namespace opaline::runtime
