#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/picture/band.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::runtime {

/// What the samples of a picture are seen through.
struct VolumePass {
    const LitVolumes& volumes;
    const Camera& camera;
    CameraFrame frame;
    std::uint32_t supersampling = 1;       ///< S: the samples of a pixel are S x S
    const LayerLight* layer = nullptr;     ///< of the cloud layer in the picture, if there is one
    std::span<const LayerSheet> sheets{};  ///< of the samples; empty without a layer
};

/// Composes the volumes between the eye and what each sample sees: color = L + T color, L and T
/// (volume_march.h) along the sample's ray up to band.inverse_distance, without end where that is
/// 0. Light is smooth between surfaces: a pixel none of whose samples sees a surface before the end
/// of the volumes is marched once, through its centre. Precondition: the band holds whole pixels.
///
/// With a layer the ray ends at the ground too, and is marched in two parts, before and behind the
/// sample's sheet at min(distance, end), of radiance A and transmittance T_S (see_layer.h):
///
///     color = L_1 + T_1 (A + T_S L_2 + T_2 (color - A)).
///
/// So suns and their glow are dimmed by all that is before them. Pixels whose samples see the
/// sheet at distances that differ by more than kSheetTolerance of the volumes' depth are marched
/// sample by sample.
void draw_volumes(const VolumePass& pass, const Band& band, std::span<formats::Rgb> color);
inline constexpr double kSheetTolerance = 1.0 / 32;

}  // namespace opaline::runtime
