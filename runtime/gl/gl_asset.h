#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "runtime/embed_gl/dot_batches.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// An asset's mesh and materials on the GPU.
struct GlAsset {
    std::uint32_t vertices = 0;
    std::vector<formats::PrimitiveRecord> primitives;
    formats::Emitters emitters;  ///< without the rows that they light
    GlBuffer position, base_color, texcoord, triangle;
    bool has_translucent = false;
    std::vector<float> roughness;  ///< of each primitive; empty: no translucent one is glossy
    std::vector<formats::GlossRecord> gloss;  ///< of each primitive; empty: no opaque one is
    std::vector<formats::HoleRecord> holes;   ///< as formats::HolesView::record
    std::vector<formats::NormalMapRecord> normal_maps;  ///< as formats::NormalMapsView::record
    GlBuffer tangent;       ///< where there is a normal map: formats::Tangent
    GlBuffer vertex_alpha;  ///< where vertices have alpha
    GlBuffer openness;      ///< where one is: formats::Openness of each vertex
    GlBuffer normal;        ///< where has_translucent, glossy or with a normal map
    GlBuffer srgb_table;    ///< linear value of each 8-bit code, 256 floats
    GlVertexArray vertex_array;
    std::vector<GlTexture> images;  ///< 8-bit codes, undecoded
    std::size_t resident = 0;       ///< [bytes]
};

/// Uploads. `radiance`: the buffer of what vertices send to the eye (Relight). Errors: resource
/// (memory, an image larger than the driver takes).
formats::Result<GlAsset> upload_asset(const formats::AssetView& asset, GLuint radiance);

}  // namespace opaline::runtime
