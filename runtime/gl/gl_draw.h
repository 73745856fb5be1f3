#pragma once

#include <array>
#include <cstdint>

#include "formats/opal/result.h"
#include "runtime/gl/gl_asset.h"
#include "runtime/gl/gl_environment.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/light_vector.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/picture.h"
#include "runtime/terms.h"

namespace opaline::runtime {

struct DrawPrograms {
    std::array<GlProgram, 6> surface;  ///< plain, textured; translucent, both; glossy, both
    GlProgram background, resolve;
    GlVertexArray nothing;  ///< for passes without vertex data
};
/// Only those that the asset has surfaces for. Errors: resource.
formats::Result<DrawPrograms> make_draw_programs(const GlAsset& asset);

/// Where a tile is drawn: samples with depth, and the box-filtered pixels.
struct DrawTarget {
    GlTexture samples, depth, pixels;
    GlFramebuffer sample_frame, pixel_frame;
};
/// For tiles of up to width x height pixels of S x S samples.
formats::Result<DrawTarget> make_draw_target(std::uint32_t width, std::uint32_t height,
                                             std::uint32_t supersampling);

/// Part of a picture, in pixels from its top left corner.
struct Tile {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// About 1 / the distances in the picture: the scale at which shaders measure them.
double view_unit(const Camera& camera);

/// Everything a tile is drawn from.
struct DrawScene {
    const GlAsset& asset;
    const GlEnvironment& environment;
    const GlSpecular& specular;
    const Rotation& rotation;
    const Camera& camera;
    std::uint32_t supersampling = 1;
    std::uint32_t terms = kAllTerms;  ///< terms.h
    bool background = true;           ///< false: black
};

/// Surfaces, then the background where none is seen, then the box filter.
void draw_tile(const DrawScene& scene, const DrawPrograms& programs, const DrawTarget& target,
               const Tile& tile);

/// Copies the filtered tile to its place in the picture.
void read_tile(const DrawTarget& target, const Tile& tile, Picture& picture);

}  // namespace opaline::runtime
