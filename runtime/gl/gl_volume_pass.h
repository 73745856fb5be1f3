#pragma once

#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "formats/opal/volumes.h"
#include "runtime/embed_gl/volume_textures.h"
#include "runtime/emitter_light.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// The light of an asset's volumes, found on the CPU from the asset's arrays.
struct GlVolumeLight {
    formats::VolumesView volumes;
    LightVector light;                   ///< the last one; n = 0 before there is one
    std::vector<formats::Rgb> emitters;  ///< their colours; empty: 1 each
    bool shows_own = true;
    formats::TermSet terms = formats::TermSet::none;  ///< components that are uploaded
};

/// Computes the coefficients of nodes and suns' points (relight_volumes) and uploads them. Does
/// nothing where there are no volumes. `emitters`: of the asset, or none. Errors: resource (memory;
/// suns whose points take more than a texture). Precondition: light.n is the asset's cube map size.
formats::Status relight_gl_volumes(GlVolumeLight& lit, VolumeTextures& textures,
                                   const LightVector& light, const EmitterLight& emitters);

/// The same light with other components, if they are others for volumes.
formats::Status show_volume_terms(GlVolumeLight& lit, VolumeTextures& textures,
                                  formats::TermSet terms);

/// `layer`: for pictures with a cloud layer. Errors: resource. Precondition: there are some.
formats::Result<GLuint> make_volume_program(GlNames& names, const opaline_gl_volumes& volumes,
                                            bool layer);

/// The box filter for a picture with volumes: composes them with the colour and depth of the
/// samples as draw_volumes (picture/volume_pass.h) does, and filters, in one go. The samples and
/// their depth are bound as texture units 0 and 1, with a layer also its sheets' light and
/// transmittance (LayerTarget) as 2 and 3, the pixels as the frame, and a vertex array.
void draw_volumes_filtered(const DrawScene& scene, GLuint program, const TileView& view);

}  // namespace opaline::runtime
