#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "runtime/embed_gl/dot_batches.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// An asset on the GPU: transport as it stands in the file, and the mesh.
struct GlAsset {
    std::uint32_t cubemap_size = 0, vertices = 0, code_bits = 8, index_bytes = 2;
    std::vector<formats::PrimitiveRecord> primitives;
    std::vector<DotBatch> batches;
    formats::Emitters emitters;  ///< a copy, which is added up on the CPU

    GlBuffer transport;  ///< of all batches (dot_batches.h)
    /// <T_0, L> of every vertex, four floats each; zeros at first. Of translucent and thin-walled
    /// ones what they show the eye, without Fresnel's factor.
    GlBuffer radiance;
    GlBuffer position, base_color, texcoord, triangle;
    bool has_translucent = false;
    std::vector<float> roughness;  ///< of each primitive; empty: no translucent one is glossy
    std::vector<formats::GlossRecord> gloss;  ///< of each primitive; empty: no opaque one is
    std::vector<formats::HoleRecord> holes;   ///< as formats::HolesView::record
    GlBuffer vertex_alpha;                    ///< where vertices have alpha
    GlBuffer openness;                        ///< where one is: formats::Openness of each vertex
    GlBuffer normal;                          ///< where has_translucent, needs_view or glossy
    GlBuffer product;     ///< where a primitive needs_view: <T_k, L> of every row
    GlBuffer srgb_table;  ///< linear value of each 8-bit code, 256 floats
    GlVertexArray vertex_array;
    std::vector<GlTexture> images;  ///< 8-bit codes, undecoded
    std::size_t resident = 0;       ///< [bytes]
};

/// Uploads. Errors: resource (memory, an image larger than the driver takes, a row larger than the
/// limits).
formats::Result<GlAsset> upload_asset(const formats::AssetView& asset, const DotLimits& limits);

/// Binds part of a buffer for the shaders of the next dispatch.
void bind_storage(GLuint binding, const GlBuffer& buffer, const BoundRange& range);

}  // namespace opaline::runtime
