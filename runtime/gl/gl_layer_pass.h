#pragma once

#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"

namespace opaline::runtime {

struct LayerPrograms {
    GLuint see = 0;                 ///< along the rays of corners and of samples
    GLuint smooth = 0, spread = 0;  ///< which pixels corners do for; to their samples
};
/// `sheet`: write what volumes need of the layer (clouds/see_layer.h), too. Errors: resource.
formats::Result<LayerPrograms> make_layer_programs(GlNames& names, const LayerKind& kind,
                                                   bool sheet);

/// A LayerSheet a texel: its radiance with its distance [m], its transmittance; none: not written.
struct SheetTextures {
    GlTexture light, through;
};

/// What a layer is drawn into, besides the samples.
struct LayerTarget {
    GlTexture corners, means;    ///< of pixels
    GlTexture samples, is_done;  ///< composed; a depth buffer: 0 where a sample is left
    SheetTextures corner_sheet, mean_sheet, sample_sheet;
    GlFramebuffer corner_frame, mean_frame, sample_frame;
};

/// The samples as seen through the layer, with the ground and the sky, as draw_layers
/// (picture/layer_pass.h) has it: from the samples in texture unit 1 and their depth in unit 2 to
/// target.samples. A vertex array is bound; depth is not tested, before and after.
void draw_gl_layers(const DrawScene& scene, const LayerPrograms& programs, const TileView& view,
                    const LayerTarget& target);

}  // namespace opaline::runtime
