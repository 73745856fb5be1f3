#pragma once

#include "bake/plan/row_layout.h"
#include "bake/receivers/surface_points.h"
#include "bake/scene/texture_pyramid.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What the light of a row is multiplied by where it is shown, at a point of a surface: base colour
/// with vertex colours, veins and image, and the share that gloss leaves to the diffuse lobe, as a
/// mean over diffuse views. `layout`: of its material; `view`: what images are looked up over;
/// null: at the point.
formats::Rgb eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                 const SurfacePoint& point, const TextureView* view = nullptr);

}  // namespace opaline::bake
