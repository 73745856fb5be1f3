#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"
#include "runtime/embed_gl/gl_asset.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/light_vector.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// An environment on the GPU, for the background: the map in full float precision and the discs.
struct GlEnvironment {
    enum class Map : std::int32_t { none = 0, lat_long = 1, cube = 2 } map = Map::none;
    GLuint texture = 0;  ///< array of one layer (lat-long) or six (cube)
    GLuint discs = 0;    ///< a row each: direction, chord of the radius; radiance, 0
    std::int32_t disc_count = 0;
    float u_offset = 0.5f, u_sign = 1.0f;
    bool rows_include_poles = false;
};

/// Errors: resource (memory, a map larger than the driver takes), usage (pixel count and size
/// disagree).
formats::Result<GlEnvironment> upload_environment(const formats::Environment& environment,
                                                  const GlFunctions& functions, GlNames& names);

/// Everything a tile is drawn from.
struct DrawScene {
    const formats::AssetView& asset;
    const GlAsset& gl;
    const GlEnvironment& environment;
    const Rotation& rotation;
    const Camera& camera;
    std::uint32_t supersampling = 1;
    formats::TermSet terms = formats::TermSet::all;
    bool background = true;               ///< false: black
    std::span<const formats::Rgb> own{};  ///< own_radiances (gl_renderer.h)
    std::span<const LayerSun> layer_suns{};
};

/// Where a tile's samples lie in the picture.
struct TileGrid {
    float columns = 0, rows = 0;            ///< samples of the whole picture
    float first_column = 0, first_row = 0;  ///< of the tile
    float tile_columns = 0, tile_rows = 0;
};

/// What passes draw with: the camera, and the tile it is looked at through.
struct TileView {
    CameraFrame frame;
    TileGrid grid;
};

/// About 1 / the distances in the picture: the scale at which shaders measure them.
double view_unit(const Camera& camera);

void set_vec3(GLuint program, GLint location, formats::Vec3 v);

/// Binds the map and the discs, and sets the uniforms of environment.glsl from location `first` on.
/// The program is in use.
void bind_environment(const GlEnvironment& environment, const Rotation& rotation, GLuint program,
                      GLint first);

/// Sets what screen passes find the ray of a sample by, from location `first` on: the tile's first
/// sample, samples to the image plane, its axes to the right and down, forward.
void set_rays(const TileView& view, GLuint program, GLint first);

/// Sets a mat3 that turns world directions into the light's frame.
void set_light_from_world(const Rotation& rotation, GLuint program, GLint location);

}  // namespace opaline::runtime
