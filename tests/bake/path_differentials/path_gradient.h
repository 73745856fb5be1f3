#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// Relative derivatives d ln of the factors of a path's contribution, for one column, as the value
/// table has them.

/// Of N.D, which is clamped to `kLeastCosine` where it divides.
inline constexpr double kLeastCosine = 1e-4;
inline double dln_cosine(const glm::dvec3& N, const glm::dvec3& D, const glm::dvec3& dN,
                         const glm::dvec3& dD) {
    const double cosine = glm::dot(N, D);
    const double least = std::copysign(kLeastCosine, cosine);
    return (glm::dot(dN, D) + glm::dot(N, dD)) / (std::abs(cosine) < kLeastCosine ? least : cosine);
}

/// Of a power of a cosine, (R.D)^S: a Phong lobe.
inline double dln_power(const glm::dvec3& R, const glm::dvec3& D, double exponent,
                        const glm::dvec3& dR, const glm::dvec3& dD) {
    return exponent * dln_cosine(R, D, dR, dD);
}

/// Of the phase function of Henyey and Greenstein at a cosine that changes by dcosine.
inline double dln_henyey_greenstein(double g, double cosine, double dcosine) {
    return 3 * g * dcosine / (1 + g * g - 2 * g * cosine);
}

/// A pair of directions away from a surface, and their changes.
struct DirectionPair {
    glm::dvec3 in{0}, out{0};
    glm::dvec3 din{0}, dout{0};
};

/// Of the isotropic microfacet lobe D(h) G2 / (4 cos_i cos_o) [Walter2007] with height-correlated
/// masking [Heitz2014]; alpha in (0, 1], both cosines > 0.
double dln_microfacet(const glm::dvec3& N, const glm::dvec3& dN, const DirectionPair& pair,
                      double alpha);

/// Two vertices at distance r, and the relative changes of what lies between them.
/// cos cos' / r^2: the sum of both cosines' and -2 dr / r.
inline double dln_geometry(double dln_cosine_near, double dln_cosine_far, double r, double dr) {
    return dln_cosine_near + dln_cosine_far - 2 * dr / r;
}

}  // namespace opaline::bake
