#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "runtime/picture/band.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::runtime {

/// What the samples of a picture are seen through.
struct VolumePass {
    const LitVolumes& volumes;
    const Camera& camera;
    CameraFrame frame;
    std::uint32_t supersampling = 1;  ///< S: the samples of a pixel are S x S
};

/// Composes the volumes between the eye and what each sample sees: color = L + T color, L and T
/// (volume_march.h) along the sample's ray up to band.inverse_distance, without end where that is
/// 0. Light is smooth between surfaces: a pixel none of whose samples sees a surface before the end
/// of the volumes is marched once, through its centre. Precondition: the band holds whole pixels.
void draw_volumes(const VolumePass& pass, const Band& band, std::span<formats::Rgb> color);

}  // namespace opaline::runtime
