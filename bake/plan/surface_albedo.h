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

/// The share of light that leaves a point of a surface again.
struct SurfaceAlbedo {
    /// Base colour with vertex colours, veins and image; of a glossy surface times the share that
    /// its lobe does not mirror. A thin wall reflects and transmits shares of this.
    formats::Rgb diffuse{1, 1, 1};
    formats::Rgb mirrored{0, 0, 0};  ///< by the lobe: it stays on the side where it arrives

    formats::Rgb sum() const { return diffuse + mirrored; }
};

/// Both as means over diffuse views. Mirrored light goes on as if diffuse. `layout`: of its
/// material; `view`: footprint of image look-ups; null: at the point.
SurfaceAlbedo eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                  const SurfacePoint& point, const TextureView* view = nullptr);

}  // namespace opaline::bake
