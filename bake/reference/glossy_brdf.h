#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bake/base/frame.h"
#include "bake/reference/hit_scene.h"
#include "formats/scene.h"

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

/// What a point of an opaque surface reflects with: factors and textures looked up.
struct OpaqueSurface {
    glm::vec3 base_color{1};
    float metallic = 0, roughness = 1;
    glm::vec3 f0{0};                    ///< of its dielectric part: reflectance at normal incidence
    float f90 = 0;                      ///< and at grazing; 0: none
    glm::vec3 reflect{1}, transmit{0};  ///< shares of diffuse light that stay on this side, and not

    bool is_diffuse() const { return metallic == 0 && f90 == 0; }
};

/// `view`: as base_color_at's.
OpaqueSurface opaque_surface_at(const formats::Scene& scene, const SurfaceHit& hit,
                                const TextureView* view = nullptr);
OpaqueSurface opaque_surface_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                                       std::uint32_t vertex);

/// Metallic-roughness reflection at one point, as one direction (the eye, or back along the path)
/// sees it. Two lobes:
///     f_s = D V (F0 + (F90 - F0)(1 - o.h)^5) (1 + F0 (1/E1(o) - 1)),
///     f_d = c (1 - m) (1 - max over channels of E_s(o)) / pi,
/// with E1 the directional albedo of facets that reflect everything and E_s that of f_s. The factor
/// of f_s gives back what facets reflect more than once [Turquin2019]. Neither lobe depends on the
/// light's direction otherwise, so f_d is one transport row times a function of the eye. Both are
/// not reciprocal in these factors; together they reflect at most all light.
struct GlossyBrdf {
    Frame frame;           ///< about the normal
    glm::dvec3 to_eye{0};  ///< unit, local; at least kGrazingCosine above the horizon
    double alpha = 1;      ///< GGX width
    glm::dvec3 f0{0};      ///< reflectance of a facet at normal incidence
    glm::dvec3 f90{0};     ///< and at grazing
    glm::dvec3 compensation{1};
    glm::vec3 mirrored_albedo{0}, diffuse_albedo{0};
};

/// `normal` and `to_eye` are unit, in world space. An eye below the horizon, which an interpolated
/// normal may have, counts as grazing.
GlossyBrdf make_glossy_brdf(const OpaqueSurface& surface, glm::vec3 normal, glm::vec3 to_eye);

/// A direction and what goes with it.
struct LobeSample {
    glm::vec3 direction{0};  ///< unit, world space
    glm::vec3 weight{0};     ///< f_s * cosine / pdf, at most `compensation`
    float pdf = 0;           ///< [1/sr]
};

/// The specular lobe, sampled by its visible normals; u, v in [0, 1). Nothing where the direction
/// is below the horizon, so that the density integrates to less than 1 over the hemisphere.
std::optional<LobeSample> sample_mirrored(const GlossyBrdf& brdf, float u, float v);

/// The specular lobe toward a direction of the light.
struct LobeValue {
    glm::vec3 response{0};  ///< f_s * cosine [1/sr]
    float pdf = 0;          ///< of sample_mirrored [1/sr]
};
LobeValue eval_mirrored(const GlossyBrdf& brdf, glm::vec3 to_light);

}  // namespace opaline::bake
