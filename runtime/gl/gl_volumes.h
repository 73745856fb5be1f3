#pragma once

#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "formats/opal/volumes.h"
#include "runtime/embed_gl/volume_textures.h"
#include "runtime/emitter_light.h"
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

}  // namespace opaline::runtime
