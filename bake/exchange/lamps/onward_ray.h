#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bake/exchange/lamps/surface_elements.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "bake/scene/texture_pyramid.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a surface does to light that arrives at a point of one of its sides, both diffusely.
struct BounceColor {
    glm::dvec3 reflect{0};   ///< to the side that it came from, in [0, 1]
    glm::dvec3 transmit{0};  ///< to the other side: of thin-walled surfaces
};

/// At a point of a triangle, `weights` barycentric. What is mirrored does not count (onward_ray.h).
/// Black for media, which are more than their surface, and for backs of single-sided surfaces.
/// `view`: footprint of texture look-ups; null: at the point.
BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights, const TextureView* view = nullptr);

/// The metal that a point of an opaque surface is made of: base color, how much of it is metal in
/// [0, 1], GGX alpha. None of media, thin walls and backs of single-sided surfaces.
struct MetalPart {
    glm::dvec3 color{0};
    double metallic = 0, alpha = 1;
};
MetalPart metal_part(const formats::Scene& scene, const TriangleSide& side,
                     const glm::vec3& weights);

/// Where a ray meets a surface.
struct Arrival {
    TriangleSide side;
    glm::dvec3 weights{0};  ///< barycentric
    glm::dvec3 normal{0};   ///< unit, of the side met
    std::uint32_t material = 0;
    double distance = 0, error = 0;  ///< along the ray; of the position [m]
};

/// Nothing where the ray met nothing, or a triangle edge-on.
std::optional<Arrival> arrival_of(const PacketHits& hits, std::size_t lane);
std::optional<Arrival> find_arrival(const RayScene& surfaces, const glm::vec3& from,
                                    const glm::vec3& direction);

/// In front of a surface that a ray met, on the side that its normal points to: back along the ray,
/// as what is beside the surface may be outside in a corner. Or on the other side.
glm::dvec3 leave_surface(const glm::dvec3& from, const glm::dvec3& direction, const Arrival& at,
                         bool crosses);

inline double largest_band(const glm::dvec3& of) {
    return std::max({of.x, of.y, of.z});
}

/// A ray that a surface passes on without scattering it diffusely.
struct OnwardRay {
    glm::dvec3 direction{0};  ///< unit
    glm::dvec3 weight{0};     ///< share of the light that it takes on, by band
    bool crosses = false;     ///< goes on behind the surface
};

/// How much a metal mirrors, in its largest band: the probability by which a particle is mirrored
/// rather than reflected diffusely. 0 of dielectrics, whose mirrored light is left out.
double mirror_chance(const formats::Scene& scene, const Arrival& at, const glm::dvec3& direction);

/// The part of light that a metal mirrors, about its interpolated normal: a reflection by a visible
/// facet [Heitz2018], Schlick's reflectance of the base color, times `metallic`. Light that
/// facets reflect more than once is left out. The columns of `path` follow the ray. Nothing where
/// the ray ends below the surface or nothing is mirrored. x: two random numbers.
std::optional<OnwardRay> mirror_ray(const formats::Scene& scene, const Arrival& at,
                                    const glm::dvec3& direction, std::array<double, 2> x,
                                    const DifferentialRules& rules, PathDifferential& path);

/// Whether light crosses a surface straight: media without variation that fill a body.
bool lets_through(const formats::Scene& scene, const Arrival& at);

/// Refraction into a medium, the share that enters; or out of it: refracted, or mirrored by chance.
/// What does not scatter has the roughness of its medium, as in the reference. x: three random
/// numbers. What a medium's outside mirrors is left out: it goes on as if diffuse. Precondition:
/// lets_through.
std::optional<OnwardRay> cross_boundary(const formats::Scene& scene, const Arrival& at,
                                        const glm::dvec3& direction, std::array<double, 3> x,
                                        const DifferentialRules& rules, PathDifferential& path);

/// Of four numbers as random_uniform gives them.
inline std::array<double, 3> first_three(const std::array<float, 4>& x) {
    return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

/// exp(-(sigma_s + sigma_a) distance) of the medium behind the back that a ray met; 1 where it met
/// a front or no medium.
glm::dvec3 straight_transmittance(const formats::Scene& scene, const Arrival& at);

}  // namespace opaline::bake
