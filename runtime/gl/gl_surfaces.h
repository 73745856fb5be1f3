#pragma once

#include <cstddef>
#include <map>

#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"

namespace opaline::runtime {

/// Programs for each kind of surface that an asset has, by SurfaceKind::number, and its vertices.
struct SurfacePrograms {
    std::map<std::size_t, GLuint> program;
    GlVertexArray vertices;
};
/// `gl`: of the asset, with mesh and images. Errors: resource.
formats::Result<SurfacePrograms> make_surface_programs(const formats::AssetView& asset,
                                                       GlAsset& gl);

/// The pass of surfaces: colour and depth of what is nearest.
void draw_surfaces(const DrawScene& scene, const SurfacePrograms& programs, const TileView& view);

}  // namespace opaline::runtime
