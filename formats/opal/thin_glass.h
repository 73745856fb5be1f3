#pragma once

#include <algorithm>
#include <cmath>

namespace opaline::formats {

/// Share of unpolarised light that passes a pane whose two faces are smooth and parallel,
/// reflections between them included: T = (1 - R) / (1 + R), R that of one face by Fresnel.
/// `cosine`: of the direction with the normal, in [0, 1]; `eta`: index of refraction, >= 1, or 0
/// for an infinite one. Absorption not counted. shaders/holes.glsl does the same.
inline float thin_glass_transmittance(float cosine, float eta) {
    if (!(cosine > 0) || !(eta > 0)) return 0;
    const float c = std::min(cosine, 1.0f);
    const float behind = std::sqrt((eta - 1) * (eta + 1) + c * c);  // eta times the cosine inside
    const float s = c + behind, p = eta * eta * c + behind;
    const float face = std::min(2 * c * behind * (1 / (s * s) + eta * eta / (p * p)), 1.0f);
    return face / (2 - face);
}

}  // namespace opaline::formats
