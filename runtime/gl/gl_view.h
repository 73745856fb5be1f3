#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"
#include "runtime/gl/gl_asset.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// The compute shader that makes one radiance of a vertex's several terms, specialised for each
/// number and kind of them that the asset has; none where no vertex has several.
struct ViewPrograms {
    struct Sum {
        std::uint32_t terms = 0;
        bool is_separate = false, is_sheet = false;
        GlProgram program;
    };
    std::vector<Sum> sums;
};
formats::Result<ViewPrograms> make_view_programs(const GlAsset& asset);

/// Fills the part of asset.radiance of primitives that need a view from asset.product: what they
/// show `eye` of the components `terms` without their Fresnel factor. `unit` is about 1 /
/// the distances in the scene. Errors: resource.
formats::Status dispatch_views(const GlAsset& asset, const ViewPrograms& programs,
                               formats::Vec3 eye, float unit, formats::TermSet terms);

}  // namespace opaline::runtime
