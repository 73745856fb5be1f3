#pragma once

#include <array>

#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/gl/gl_scene.h"

namespace opaline::runtime {

/// Programs for each kind of surface that an asset has, by SurfaceKind::number.
struct SurfacePrograms {
    std::array<GlProgram, 8192> program;
};
/// Errors: resource.
formats::Result<SurfacePrograms> make_surface_programs(const GlAsset& asset);

/// The pass of surfaces: colour and depth of what is nearest.
void draw_surfaces(const DrawScene& scene, const SurfacePrograms& programs, const TileView& view);

}  // namespace opaline::runtime
