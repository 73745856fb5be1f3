#pragma once

#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"

namespace opaline::runtime {

/// `layer`: for pictures with a cloud layer. Errors: resource. Precondition: there are some.
formats::Result<GLuint> make_volume_program(GlNames& names, const opaline_gl_volumes& volumes,
                                            bool layer);

/// The box filter for a picture with volumes: composes them with the colour and depth of the
/// samples as draw_volumes (picture/volume_pass.h) does, and filters, in one go. The samples and
/// their depth are bound as texture units 0 and 1, with a layer also its sheets' light and
/// transmittance (LayerTarget) as 2 and 3, the pixels as the frame, and a vertex array.
void draw_volumes_filtered(const DrawScene& scene, GLuint program, const TileView& view);

}  // namespace opaline::runtime
