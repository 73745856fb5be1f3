#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "formats/opal/asset.h"
#include "formats/opal/holes.h"
#include "formats/opal/rgb.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"
#include "runtime/emitter_light.h"
#include "runtime/specular.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {

/// What a shaded point is, for vertices (shade.h) and for samples of a picture
/// (picture/software_renderer.h); shaders/surface.frag.glsl does the same steps.

/// What all points of a primitive share.
struct SurfaceMaterial {
    const formats::PrimitiveRecord* primitive = nullptr;
    const formats::GlossRecord* gloss = nullptr;  ///< of a glossy opaque primitive; else nothing
    const SpecularLight* light = nullptr;         ///< nothing: no specular reflection is added
    SpecularLobe lobe;  ///< of a glossy translucent primitive; no radiance without `light`
    const formats::OwnLight* own = nullptr;  ///< nothing: it sends out no light that is shown
    formats::Rgb own_radiance;               ///< under the emitters' colours, without its image
};

/// `light`: as SoftwareOptions::specular. Without TermSet::specular in `terms` none is used.
SurfaceMaterial surface_material(const formats::AssetView& asset, std::size_t primitive,
                                 formats::TermSet terms, const SpecularLight* light,
                                 const EmitterLight& emitters);

/// One point of it.
struct SurfacePoint {
    formats::Rgb radiance;    ///< sum_k h_k <T_k, L>: rows and view terms, without base colour
    formats::Rgb base_color;  ///< times its image
    float metallic = 0, roughness = 0;  ///< glossy opaque: factors times their image
    ViewOfReceiver view;                ///< diffuse primitives without gloss need none
    formats::Vec3 open_axis;            ///< glossy: mean open direction of the front, unit or zero
    float open_fraction = 1;
    formats::Rgb own;  ///< radiance that the surface sends out by itself
};

/// Sets metallic and roughness from the primitive's record and image. Precondition: has gloss.
void set_gloss_factors(const formats::AssetView& asset, const SurfaceMaterial& material,
                       formats::Float2 texcoord, SurfacePoint& point);

/// Sets `own` from the primitive's record and image.
void set_own_light(const formats::AssetView& asset, const SurfaceMaterial& material,
                   formats::Float2 texcoord, SurfacePoint& point);

/// Truncated rows ring below zero where the truth is black; sums of absurd scales overflow: finite
/// and not negative, NaN as black (the comparison is false for it).
inline float displayable(float x) {
    return x > 0.0f ? std::min(x, std::numeric_limits<float>::max()) : 0.0f;
}
inline formats::Rgb displayable(formats::Rgb c) {
    return {displayable(c.r), displayable(c.g), displayable(c.b)};
}

/// Outgoing radiance toward the eye, finite and not negative: diffuse base_color * radiance;
/// translucent base_color * Ft * radiance, plus what the boundary mirrors of the sky and, where it
/// is blocked, of base_color * radiance (specular.h); glossy opaque
/// base_color * radiance * (1 - metallic) (1 - max E), plus the specular lobe. Rows of a metal
/// (metallic 1 without an image) hold what surfaces send to it: where its lobe is blocked it
/// mirrors their mean radiance, E (1 - v) / (1 - a) radiance, v what openness leaves of the lobe
/// and a the open fraction.
/// What the surface sends out by itself is added to all of them.
formats::Rgb shade_surface(const SurfaceMaterial& material, const SurfacePoint& point);

/// Which samples of a picture see a surface that light passes in places; shaders/holes.glsl does
/// the same steps.

/// A sample of a triangle: `column` and `row` on the grid of the whole picture, `last_vertex` the
/// triangle's third one, in the whole asset's numbering.
struct HoleSample {
    std::uint32_t column = 0, row = 0, last_vertex = 0;
    float cosine = 1;  ///< of the view with the normal, its absolute value: of glass
};

/// Alpha of a point: the record's, times `vertex_alpha`, interpolated from the vertices', times its
/// image.
float alpha_at(const formats::AssetView& asset, const formats::HoleRecord& hole,
               formats::Float2 texcoord, float vertex_alpha);

/// Whether a sample sees the surface. A mask: where alpha >= cutoff. A blend: alpha of all samples,
/// and of glass what its transmittance leaves of them, spread evenly over any part of the picture
/// by the R2 sequence (Martin Roberts, 2018), shifted by triangle, so that surfaces behind each
/// other need no sorting.
bool sees_surface(const formats::HoleRecord& hole, float alpha, const HoleSample& sample);

}  // namespace opaline::runtime
