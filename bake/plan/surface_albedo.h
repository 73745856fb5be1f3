#pragma once

#include <optional>

#include "bake/plan/row_layout.h"
#include "bake/receivers/surface_points.h"
#include "bake/scene/base_color.h"
#include "bake/scene/texture_pyramid.h"
#include "formats/opal/gloss_model.h"
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
    bool is_narrow = false;          ///< the lobe: rays follow what it mirrors (eval_narrow_lobe)

    formats::Rgb sum() const { return diffuse + mirrored; }
    /// What goes on as if diffuse of what is mirrored.
    formats::Rgb spread() const { return is_narrow ? formats::Rgb{0, 0, 0} : mirrored; }
};

/// Both as means over diffuse views. `layout`: of its material; `view`: footprint of image
/// look-ups; null: at the point.
SurfaceAlbedo eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                  const SurfacePoint& point, const TextureView* view = nullptr);

/// The lobe of an opaque or thin-walled surface at a place, and the colour of what is below it.
/// Nothing where it has none or `layout` leaves it out.
struct SurfaceLobe {
    formats::GlossSurface surface;
    formats::Rgb color;
};
std::optional<SurfaceLobe> eval_lobe(const formats::Scene& scene, const RowLayout& layout,
                                     const SurfacePlace& place);

/// The lobe alone, where it is so narrow that its light
/// goes on as rays: of a roughness below kBroadLobe.
std::optional<formats::GlossSurface> eval_narrow_lobe(const formats::Scene& scene,
                                                      const RowLayout& layout,
                                                      const SurfacePlace& place);

/// Perceptual roughness from which what a lobe mirrors goes on as if diffuse.
inline constexpr float kBroadLobe = 0.5f;

}  // namespace opaline::bake
