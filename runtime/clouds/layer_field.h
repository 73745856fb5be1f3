#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/clouds.h"
#include "runtime/clouds/mip_pyramid.h"

namespace opaline::runtime {

/// What is seen of a layer's frames at one time: (1 - share) of `first` and `share` of `second`.
struct FrameBlend {
    std::uint32_t first = 0, second = 0;  ///< below LayerRecord::frames
    float share = 0;                      ///< in [0, 1]; 0 where both are the same
    bool operator==(const FrameBlend&) const = default;
};
/// Any `time` [s]; NaN and infinity are time 0.
FrameBlend blend_frames(const formats::LayerRecord& record, double time);

/// The thickness of a layer over the world's x and z at one time [m]. `thickness` is what a GPU
/// uploads: the same levels, borders and filters.
struct LayerField {
    MipPyramid<float> thickness;    ///< [m], border repeat or zero
    FrameBlend frames;              ///< that it is of
    double low_x = 0, low_z = 0;    ///< corner of the image at this time [m]
    double size_x = 1, size_z = 1;  ///< [m]
    float base = 0, highest = 0;    ///< of the record [m]
    double cell = 1;                ///< side of a texel of level 0, the longer one [m]

    bool repeats() const { return thickness.border == MipBorder::repeat; }
    /// The level whose texels are as long as `length` [m]; below 0 where that is less than a cell.
    float level_of(double length) const;
};

/// Wind moves the layer by wind * time [s]; layers that repeat move within their period, so that
/// no digits are lost however late it is. Frames are blended by blend_frames; means over larger
/// squares are those of the blend. `codes` as CloudsView::thickness_of.
LayerField make_layer_field(const formats::LayerRecord& record,
                            std::span<const std::uint16_t> codes, double time);

/// Trilinear [m]; x, z finite [m].
float sample_thickness(const LayerField& field, double x, double z, float level);

/// Of the thickness, dH/dx and dH/dz [1], by differences over a texel of `level` on either side, so
/// that it is continuous.
struct LayerSlope {
    float x = 0, z = 0;
};
LayerSlope sample_slope(const LayerField& field, double x, double z, float level);

}  // namespace opaline::runtime
