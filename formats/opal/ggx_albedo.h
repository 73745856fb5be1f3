#pragma once

#include <cstdint>
#include <span>

namespace opaline::formats {

/// Directional albedo of a GGX lobe [Walter2007] with height-correlated Smith shadowing
/// [Heitz2014] and Schlick's Fresnel term F0 + (F90 - F0) (1 - v.h)^5: the share of light from
/// everywhere alike that the lobe reflects toward a view,
///
///     E(c, alpha) = int f_s(v, l) n.l dl = F0 * of_f0 + F90 * of_f90.
///
/// Their sum is E1, the albedo for F = 1; what it lacks of 1 is light scattered more than once
/// between facets.
struct GgxAlbedo {
    float of_f0 = 0, of_f90 = 0;

    float e1() const { return of_f0 + of_f90; }
};

/// By the midpoint rule over steps x steps visible normals [DupuyBenyoub2023]. Preconditions:
/// cosine in (0, 1], alpha > 0.
GgxAlbedo integrate_ggx_albedo(double cosine, double alpha, int steps);

/// Rows of roughness 0 ... 1 in equal steps, columns of the square root of the cosine, 0 ... 1 in
/// equal steps: the albedo changes fastest at grazing views.
inline constexpr std::uint32_t kAlbedoRows = 64, kAlbedoColumns = 64;

/// The table, computed at the first call (some 0.1 s).
std::span<const GgxAlbedo> ggx_albedo_table();

/// Bilinear in the table; `roughness` perceptual, alpha = ggx_alpha(roughness). Cosines and
/// roughnesses outside [0, 1] are clamped. Error of each part and of their sum: at most 1e-3 for
/// cosines from 0.1, 2.5e-3 for roughnesses from 0.1, 1e-2 for cosines from 0.001 (tested against
/// integrate_ggx_albedo).
GgxAlbedo ggx_albedo(float cosine, float roughness);

/// Below it a lobe is a mirror's to any eye.
inline constexpr float kLeastAlpha = 1e-3f;
inline float ggx_alpha(float roughness) {
    const float alpha = roughness * roughness;
    return alpha > kLeastAlpha ? alpha : kLeastAlpha;
}

}  // namespace opaline::formats
