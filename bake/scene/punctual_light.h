#pragma once

#include <glm/glm.hpp>

#include "formats/scene.h"

namespace opaline::bake {

/// Light without a surface that arrives at a point, if nothing is between.
struct ArrivingLight {
    glm::vec3 to_light{0};         ///< unit
    float distance = 0;            ///< [m] to the light; infinite of directional ones
    formats::Rgb irradiance = {};  ///< [lx] on a surface that faces the light; 0: none arrives
};

/// A light of KHR_lights_punctual seen from a point [m, the scene's frame], by the formulas that
/// the extension recommends:
///
///     E = I / d^2 window(d) spot(c),   window = max(0, 1 - (d / range)^4),
///     spot = clamp((c - cos outer) / max(0.001, cos inner - cos outer), 0, 1)^2,
///
/// c the cosine between the light's direction and that of its light to the point. Of a directional
/// light, E is its intensity. At the light's own position nothing arrives.
ArrivingLight light_at(const formats::Light& light, glm::vec3 position);

/// Flux [lm] that a point or spot light of intensity 1 cd sends out, without its range: the
/// integral of `spot` over the sphere. Precondition: not directional.
double flux_per_intensity(const formats::Light& light);

}  // namespace opaline::bake
