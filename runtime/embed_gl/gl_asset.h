#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/image_textures.h"
#include "runtime/embed_gl/layer_textures.h"
#include "runtime/embed_gl/mirrored_light.h"
#include "runtime/embed_gl/relight.h"
#include "runtime/embed_gl/volume_textures.h"

namespace opaline::runtime {

/// All that a context holds of an asset and its light: behind opaline_gl, and in the renderer's own
/// context (runtime/gl). Every call wants a SavedState around it in a host's context.
struct GlAsset {
    GlFunctions gl;
    GlNames names{gl};
    Relight relight{gl};
    MirroredLight mirrored{gl};
    GlossyLight glossy{gl};
    ImageTextures images{gl};
    VolumeTextures volumes{gl};
    LayerTextures layer{gl};
    std::vector<formats::GlossRecord> gloss;  ///< of each primitive, or none
    std::vector<formats::PrimitiveRecord> primitives;
    opaline_gl_objects objects{};
    std::uint64_t specular_id = 0;  ///< of the SpecularLight that is uploaded

    GlAsset() = default;
    GlAsset(const GlAsset&) = delete;  // members refer to each other
    GlAsset& operator=(const GlAsset&) = delete;

    /// Uploads what `flags` of opaline_gl_flags ask for, dark, once `gl` is loaded. Statuses: as
    /// opaline_gl_create.
    opaline_status upload(const formats::AssetView& asset, std::uint32_t flags,
                          const RelightOptions& options);

    /// What glossy surfaces mirror. Turning a light leaves its maps as they are.
    void mirror(const SpecularLight& light);
};

}  // namespace opaline::runtime
