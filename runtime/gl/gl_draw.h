#pragma once

#include <cstdint>

#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "runtime/gl/gl_layer_pass.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"
#include "runtime/gl/gl_surfaces.h"
#include "runtime/picture/picture.h"

namespace opaline::runtime {

struct DrawPrograms {
    SurfacePrograms surfaces;
    GLuint background = 0, resolve = 0;
    GLuint volumes = 0;               ///< in place of `resolve`, where there are volumes
    GLuint volumes_around_layer = 0;  ///< in place of `volumes`, where there is a layer too
    LayerPrograms layers;             ///< where there are any (gl_layer_pass.h)
    GlVertexArray nothing;            ///< for passes without vertex data
};
/// Only those that the asset has surfaces and volumes for. `gl`: of that asset. Errors: resource.
formats::Result<DrawPrograms> make_draw_programs(const formats::AssetView& asset, GlAsset& gl);

/// Where a tile is drawn: samples with depth, and the box-filtered pixels.
struct DrawTarget {
    GlTexture samples, depth, pixels;
    GlFramebuffer sample_frame, pixel_frame;
    LayerTarget layer;  ///< where there are layers
};
/// What a picture has besides surfaces.
struct DrawParts {
    bool layers = false, volumes = false;
};
/// For tiles of up to width x height pixels of S x S samples.
formats::Result<DrawTarget> make_draw_target(const GlFunctions& gl, std::uint32_t width,
                                             std::uint32_t height, std::uint32_t supersampling,
                                             const DrawParts& parts);

/// Part of a picture, in pixels from its top left corner.
struct Tile {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// The passes of the picture (picture.h), then the box filter. The two of volumes are one:
/// gl_volume_pass.h. A layer covers the background, which is left out then.
void draw_tile(const DrawScene& scene, const DrawPrograms& programs, const DrawTarget& target,
               const Tile& tile);

/// Copies the filtered tile to its place in the picture.
void read_tile(const DrawTarget& target, const Tile& tile, Picture& picture);

}  // namespace opaline::runtime
