#pragma once

#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/gloss_model.h"
#include "formats/opal/rgb.h"
#include "runtime/gloss_light.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"
#include "runtime/view_terms.h"

namespace opaline::runtime {

/// Cell of gloss.glsl, eight floats each.
inline std::vector<float> make_cell_table(const GlossLight& light) {
    const GlossLight::Cells& c = light.cells;
    std::vector<float> table;
    table.reserve(8 * c.size());
    for (std::size_t i = 0; i < c.size(); ++i) {
        table.insert(table.end(), {c.x[i], c.y[i], c.z[i], c.solid_angle[i], c.r[i], c.g[i], c.b[i],
                                   c.widening[i]});
    }
    return table;
}

/// Sun of gloss.glsl, eight floats each.
inline std::vector<float> make_sun_table(const GlossLight& light) {
    std::vector<float> table;
    table.reserve(8 * light.suns.size());
    for (const formats::DistantDisc& sun : light.suns) {
        table.insert(table.end(),
                     {sun.direction.x, sun.direction.y, sun.direction.z, sun.angular_radius,
                      sun.radiance.r, sun.radiance.g, sun.radiance.b,
                      static_cast<float>(formats::disc_solid_angle(sun.angular_radius))});
    }
    return table;
}

/// Specular reflection of distant light by glossy opaque surfaces (formats/opal/gloss_model.h):
///
///     L_spec = k (F0 S_0 + F90 S_90),
///     S_0 = int D V (1 - (1 - v.h)^5) n.l L(l) dl,   S_90 = int D V (1 - v.h)^5 n.l L(l) dl
///
/// Two sums of the same light, because each is good where the other is not:
/// - narrow lobes: filtered importance sampling [KrivanekColbert2008], kLobeTaps visible normals
///   [DupuyBenyoub2023], each looked up in the map whose texels are as large as the tap's share;
/// - wide lobes: the lobe at the centre of each cell of GlossLight, widened by the cell's size.
/// Between kNarrowRoughness and kWideRoughness one fades into the other. Both sums are weighted
/// means, scaled to the albedo's table: white light comes out exactly. Suns are evaluated one by
/// one with a lobe widened by their radius.
///
/// Error for a metal against the integral, RMS over a sphere relative to RMS (tested): below 2 %
/// under `studio` and `sky` for roughness from 0.3.

inline constexpr int kLobeTaps = 96;
inline constexpr float kNarrowRoughness = 0.4f, kWideRoughness = 0.5f;

/// S_0 and S_90 [W m^-2 sr^-1].
struct LobeIntegral {
    formats::Rgb of_f0, of_f90;
};

/// `normal` and `to_eye` in the light's frame, unit; `cosine` of the two, in (0, 1]. `table`: the
/// lobe's albedo toward that view.
LobeIntegral integrate_lobe(const GlossLight& light, const formats::GgxAlbedo& table,
                            float roughness, const ViewOfReceiver& view);

/// L_spec, finite and not negative, without openness. Black where light was not prepared or the
/// receiver has no normal. Behind a silhouette (cosine < 0), where interpolated normals of visible
/// points end up, it counts as seen at cosine 0 and fades to black at -0.2.
formats::Rgb eval_gloss(const GlossLight& light, const Rotation& rotation,
                        const formats::GlossSurface& surface, const ViewOfReceiver& view);

/// The part of the lobe around the mirror direction that openness leaves (specular_visibility):
/// multiplies L_spec. `axis`, `open`: as eval_specular takes them.
float gloss_visibility(const ViewOfReceiver& view, float roughness, formats::Vec3 axis, float open);

/// The cosine that a glossy surface is shaded with: that of the view, of the side which is seen.
float gloss_cosine(float cosine);

}  // namespace opaline::runtime
