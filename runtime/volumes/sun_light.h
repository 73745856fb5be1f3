#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::runtime {

/// How much of suns' light reaches the points of volumes, and what they scatter of it: fills
/// sun_coefficients(v, b, p) of all bricks and points of volumes that have suns. Point (i, j, k) of
/// a brick stands i, j, k times 8 / sun_boxes voxels from its voxel (0, 0, 0). There
///
///     V_s = min(e^-tau, 2 U_s),   tau = sum over volumes of int sigma_t density ds toward the sun
///
/// (sun_columns.h). What rows know, U_s, is coarse: means over four texels, linear between nodes.
/// But they alone know the shadows of surfaces, where they are near 0, and in coloured rows (bands
/// = 3) hues of the albedo: there it is min(e^-tau, U_s). Coefficients are lowered for what lines
/// between points are too bright (find_lowering). `reach`: of each volume U_s at nodes, share[node
/// * suns + s], not below 0. The same bits for any number of threads.
void light_sun_points(const formats::VolumesView& volumes,
                      std::span<const std::vector<formats::Rgb>> reach, unsigned threads,
                      VolumeLight& light);

}  // namespace opaline::runtime
