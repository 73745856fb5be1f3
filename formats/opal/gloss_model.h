#pragma once

#include <cstdint>

#include "formats/opal/ggx_albedo.h"
#include "formats/opal/preview_image.h"
#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Roughness of a primitive without specular reflection.
inline constexpr float kNotGlossy = -1.0f;

/// Specular reflection of one opaque primitive: glTF metallic-roughness with KHR_materials_specular
/// and KHR_materials_ior. Section GLOS, stored as is; gloss_model.h has the BRDF.
struct GlossRecord {
    float metallic = 0;            ///< factor, in [0, 1]
    float roughness = kNotGlossy;  ///< perceptual, factor, in [0, 1]; kNotGlossy: diffuse alone
    /// Reflectance at normal incidence of the dielectric part, in [0, 1]:
    /// min(((ior - 1) / (ior + 1))^2 specularColorFactor, 1) specularFactor.
    Rgb f0;
    float f90 = 1;                   ///< at grazing incidence, in [0, 1]: specularFactor
    std::uint32_t image = kNoImage;  ///< into images, linear: green times roughness, blue metallic
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;  ///< of that image
    std::uint32_t reserved = 0;

    bool is_glossy() const { return roughness >= 0; }
};
static_assert(sizeof(GlossRecord) == 40);

/// The BRDF of a glossy opaque surface: glTF metallic-roughness with a specular lobe f_s and a
/// diffuse lobe f_d,
///
///     f_s = k(c_o) D(n.h) V(n.v, n.l) (F0 + (F90 - F0) (1 - v.h)^5)
///     f_d = base_color (1 - metallic) / pi * (1 - max_rgb E(c_o))
///
/// D: GGX [Walter2007], alpha = max(roughness^2, 1e-3); V: height-correlated Smith [Heitz2014];
/// F0 = mix(f0, base_color, metallic), F90 = mix(f90, 1, metallic); k = 1 + F0 (1 / E1(c_o) - 1):
/// light scattered more than once between facets [Turquin2019]; E = k (F0 of_f0 + F90 of_f90): the
/// albedo of the compensated lobe toward a view of cosine c_o = n.v. The factor of f_d depends on
/// the view alone, so one transport row is exact, and a white surface under white light returns
/// exactly 1. f_d is not reciprocal.

/// The numbers of the BRDF at one point of a surface.
struct GlossSurface {
    float roughness = 1;  ///< perceptual
    Rgb f0;
    float f90 = 1;
    float diffuse = 1;  ///< 1 - metallic
};

/// Both factors with their image's values; base colour with its image. All are clamped to [0, 1]
/// where they enter F0, so that no surface reflects more than it receives.
GlossSurface make_gloss_surface(const GlossRecord& record, Rgb base_color, float metallic,
                                float roughness);

/// k and E at one cosine.
struct GlossAlbedo {
    GgxAlbedo table;
    Rgb compensation;   ///< k
    Rgb specular;       ///< E
    float diffuse = 1;  ///< (1 - metallic) (1 - max E): multiplies base_color <T_0, L>
};
GlossAlbedo eval_gloss_albedo(const GlossSurface& surface, float cosine);

/// D(n.h) [1/sr].
float ggx_distribution(float n_h, float alpha);

/// V = G2 / (4 n.v n.l) [1/sr], height-correlated. Both cosines above 0.
float smith_visibility(float n_v, float n_l, float alpha);

/// (1 - v.h)^5, v.h clamped to [0, 1].
float schlick_weight(float v_h);

}  // namespace opaline::formats
