#pragma once

#include <cstdint>

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

}  // namespace opaline::formats
