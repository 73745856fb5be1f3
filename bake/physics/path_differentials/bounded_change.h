#pragma once

#include <glm/glm.hpp>

#include "bake/physics/path_differentials/lobe.h"
#include "bake/physics/path_differentials/smooth_event.h"

namespace opaline::bake {

/// What a path stores where a derivative is large or infinite: clamps, and secants, which replace
/// step f'(x) by f(x + step / 2) - f(x - step / 2) with arguments inside the domain.
/// Functions return derivatives, so that step times them is what moves; those of directions are
/// perpendicular to them.

/// transfer_to_plane with |D.N_g| of at least this where it divides: moves by at most 1e4 |w|.
/// The result lies in the tangent plane at any angle.
inline constexpr double kLeastGrazing = 1e-4;
glm::dvec3 bounded_transfer(const glm::dvec3& D, const glm::dvec3& N_g, double t,
                            const glm::dvec3& dP, const glm::dvec3& dD);

/// sqrt(z + d/2) - sqrt(max(0, z - d/2)), odd in d; z >= 0. At most sqrt |d|.
double sqrt_secant(double z, double d);

/// Refraction with the secant of c_t over the step: bounded at the critical angle.
glm::dvec3 bounded_refraction(const Refraction& event, const glm::dvec3& dD, const glm::dvec3& dN,
                              double step);

/// `column` such that step times it is at most sqrt 2: a direction moves by 90 degrees.
glm::dvec3 bounded_direction(const glm::dvec3& column, double step);

/// A sample of a lobe with the secant of its sine and cosine over the radial step, and
/// bounded_direction. Tends to sample_lobe for small steps. step in (0, 1].
LobeDirection secant_of_lobe(const Lobe& lobe, double u, double v, double step);

}  // namespace opaline::bake
