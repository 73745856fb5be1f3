#pragma once

namespace opaline::bake {

/// What a GGX surface reflects of even light toward one direction, once per microfacet, with
/// Schlick's Fresnel term f0 + (f90 - f0) (1 - o.h)^5: f0 * normal + f90 * grazing.
struct DirectionalAlbedo {
    double normal = 0, grazing = 0;

    /// Of facets that reflect everything.
    double unit() const { return normal + grazing; }
};

/// `cosine` of the direction to the surface's normal, in (0, 1]; `roughness` in [0, 1].
/// Midpoint rule with `steps`^2 points over the visible normals of one half, the other being its
/// mirror image. The error of either part is below 1e-3 with 32 steps.
DirectionalAlbedo integrate_albedo(double cosine, double roughness, int steps);

/// Cosines below count as this one in `directional_albedo`.
inline constexpr double kGrazingCosine = 1e-3;

/// The same from a table, computed at the first call (about a quarter of a second) and the same on
/// every machine up to rounding. Errors: see kAlbedoError.
DirectionalAlbedo directional_albedo(double cosine, double roughness);

/// Bound on the table's error in `unit()`, of quadrature and interpolation together, for
/// roughnesses from 0.1; and for smoother surfaces, where the albedo dips at cosines like alpha.
inline constexpr double kAlbedoError = 2e-3, kSmoothAlbedoError = 1e-2;

}  // namespace opaline::bake
