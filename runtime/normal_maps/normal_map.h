#pragma once

#include "formats/opal/asset.h"
#include "formats/opal/normal_maps.h"
#include "formats/opal/vec3.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {

/// Surfaces that are shaded with the normals of an image; shaders/surface.glsl does the same steps.

/// The unit normal that a normal map gives a point (formats/README.md, `NORM`). `normal`: unit, of
/// the front; `tangent`: interpolated, not normalised. `normal` itself where the map gives no
/// direction. Precondition: the record is of this asset.
formats::Vec3 mapped_normal(const formats::AssetView& asset, const formats::NormalMapRecord& map,
                            formats::Float2 texcoord, formats::Vec3 normal,
                            formats::DecodedTangent tangent);

/// The view of the same point with the normal `mapped`, of the front. A normal that turns away from
/// an eye which sees the surface is bent toward it, to a cosine of at least 0.05 or the surface's
/// own.
ViewOfReceiver view_mapped(const ViewOfReceiver& view, formats::Vec3 mapped);

}  // namespace opaline::runtime
