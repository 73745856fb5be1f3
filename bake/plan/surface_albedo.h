#pragma once

#include "bake/plan/row_layout.h"
#include "bake/receivers/surface_points.h"
#include "bake/scene/texture_pyramid.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether light leaves an opaque surface, or rows of its material hold what leaves.
inline bool sends_light(const RowLayout& layout) {
    return layout.has_rows() || (layout.mirrors && !layout.translucent);
}

/// The share of light that leaves a point of a surface again: base colour with vertex colours,
/// veins and image; of a glossy one what its lobe leaves to that, and what the lobe mirrors, both
/// as means over diffuse views. Where mirrored light goes is not kept: it goes on as if diffuse.
/// `layout`: of its material; `view`: what images are looked up over; null: at the point.
formats::Rgb eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                 const SurfacePoint& point, const TextureView* view = nullptr);

}  // namespace opaline::bake
