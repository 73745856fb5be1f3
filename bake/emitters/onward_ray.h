#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "bake/emitters/surface_arrival.h"
#include "bake/path_differentials/path_differential.h"
#include "formats/scene.h"

namespace opaline::bake {

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
/// numbers. What a medium's outside mirrors is left out: media_light.h has it. Precondition:
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
