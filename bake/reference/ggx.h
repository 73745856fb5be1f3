#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {

/// The microfacet model of [Walter2007] with height-correlated masking [Heitz2014], isotropic.
/// Vectors are unit, in a frame whose third axis is the surface's normal, in double precision:
/// at alpha 1e-3 single precision cannot tell normals apart.

inline glm::dvec3 into_frame(const Frame& frame, glm::vec3 d) {
    const glm::dvec3 world(d);
    return {glm::dot(glm::dvec3(frame.u), world), glm::dot(glm::dvec3(frame.v), world),
            glm::dot(glm::dvec3(frame.normal), world)};
}

inline double ggx_alpha(double roughness) {
    constexpr double kLeast = 1e-3;  // a mirror, for every purpose
    return std::max(roughness * roughness, kLeast);
}

/// Density of normals D(h) [1/sr]: int D (n.h) dh = 1 over the hemisphere.
inline double ggx_density(const glm::dvec3& h, double alpha) {
    const double t = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
    return 1 / (std::numbers::pi * alpha * alpha * t * t);
}

/// sqrt(alpha^2 + (1 - alpha^2) c^2), with which masking is G1(c) = 2 c / (c + root).
inline double smith_root(double cosine, double alpha) {
    return std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine);
}

/// G2 / (4 c_o c_l): masking and shadowing, height-correlated, over the denominator of the BRDF.
inline double smith_visibility(double c_o, double c_l, double alpha) {
    return 0.5 / (c_o * smith_root(c_l, alpha) + c_l * smith_root(c_o, alpha));
}

/// G2 / G1(o): what shadowing leaves of a visible normal's reflection. In [0, 1].
inline double smith_shadowing(double c_o, double c_l, double alpha) {
    const double root_o = smith_root(c_o, alpha);
    return c_l * (c_o + root_o) / (c_o * smith_root(c_l, alpha) + c_l * root_o);
}

/// Density over solid angle of the reflections of `sample_visible_normal` [1/sr]:
/// G1(o) D(h) / (4 c_o).
inline double pdf_visible_reflection(double c_o, const glm::dvec3& h, double alpha) {
    return ggx_density(h, alpha) / (2 * (c_o + smith_root(c_o, alpha)));
}

/// A normal as `o` sees them, density G1(o) (o.h) D(h) / c_o [Heitz2018]. u, v in [0, 1).
/// Precondition: o.z > 0.
inline glm::dvec3 sample_visible_normal(const glm::dvec3& o, double alpha, double u, double v) {
    const glm::dvec3 seen = glm::normalize(glm::dvec3(alpha * o.x, alpha * o.y, o.z));
    const double length = std::hypot(seen.x, seen.y);
    const glm::dvec3 t1 =
        length > 0 ? glm::dvec3(-seen.y, seen.x, 0) / length : glm::dvec3(1, 0, 0);
    const glm::dvec3 t2 = glm::cross(seen, t1);
    const double radius = std::sqrt(u), phi = 2 * std::numbers::pi * v;
    const double x = radius * std::cos(phi), share = 0.5 * (1 + seen.z);
    const double y = (1 - share) * std::sqrt(1 - x * x) + share * radius * std::sin(phi);
    const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
    const glm::dvec3 h = x * t1 + y * t2 + z * seen;
    return glm::normalize(glm::dvec3(alpha * h.x, alpha * h.y, std::max(1e-12, h.z)));
}

/// Schlick's (1 - o.h)^5: how far the Fresnel reflectance is from its value at normal incidence.
inline double schlick_weight(double o_h) {
    const double x = std::clamp(1 - o_h, 0.0, 1.0), x2 = x * x;
    return x2 * x2 * x;
}

}  // namespace opaline::bake
