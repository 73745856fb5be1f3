#pragma once

#include <cstdint>

#include "formats/opal/result.h"
#include "formats/opal/vec3.h"
#include "runtime/gl/gl_asset.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// The compute shader that adds up the terms of translucent vertices, made only for an asset that
/// has such.
struct ViewProgram {
    GlProgram sum;
};
formats::Result<ViewProgram> make_view_program(const GlAsset& asset);

/// Fills the translucent vertices' part of asset.irradiance from asset.product: what they show
/// `eye` of the components `terms` (terms.h) without their Fresnel factor. `unit` is about 1 / the
/// distances in the scene. Errors: resource.
formats::Status dispatch_views(const GlAsset& asset, const ViewProgram& program, formats::Vec3 eye,
                               float unit, std::uint32_t terms);

}  // namespace opaline::runtime
