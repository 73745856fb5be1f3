#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "formats/scene.h"

namespace opaline::bake {

/// A straight flight in a homogeneous medium, up to a surface or a scattering.
struct MediumFlight {
    std::optional<float> length{};  ///< [m] to a scattering; none: to the surface
    std::array<float, 3> share{};   ///< of the bands, after it
};

/// (1 - g) sigma_s [1/m]: of scattering alike in all directions (similarity [Wyman1989]).
std::array<float, 3> isotropic_scattering(const formats::Medium& medium);

/// Draws a flight with that scattering by the numbers u and v, in [0, 1); `share`: what each band
/// carries, >= 0; `distance` [m]: of the surface. One band is drawn in proportion to what it
/// carries, and the balance heuristic over all of them weighs it, so that no flight makes the sum
/// over bands larger. The mean over u and v is what the medium does.
MediumFlight draw_flight(const formats::Medium& medium, const std::array<float, 3>& share,
                         float distance, float u, float v);

/// Uniform over the unit sphere, of two numbers in [0, 1).
glm::vec3 direction_on_sphere(float u, float v);

}  // namespace opaline::bake
