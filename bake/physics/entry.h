#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace opaline::bake {

/// The boundary of a medium of relative index eta > 0, as light enters through it.
template <class Real>
struct Interface {
    Real eta = 1;
    bool jacobian = true;  ///< false: J = 1, as [Wang2005] prints it (2.4 times too bright)
};

/// Light that enters at an angle with cosine c outside and c' inside.
template <class Real>
struct Entry {
    Real throughput = 0;        ///< Ft(c) J, J = c / (eta^2 c'): radiance times solid angle
                                ///< (README.md, "Transport")
    Real path_ratio = 1;        ///< s'/s = c/c': length after refraction by the straight distance
    Real refracted_cosine = 1;  ///< c' = sqrt(1 - (1 - c^2) / eta^2)
};

/// Beyond the critical angle (eta < 1) and at grazing incidence the throughput is 0.
///
/// Ft J as one product: with the transmittances of both polarisations written as 4 eta c c' / (c +
/// eta c')^2 and 4 eta c c' / (eta c + c')^2, the factor c' of J cancels, and
///     Ft J = (2 c^2 / eta) (1 / (c + eta c')^2 + 1 / (eta c + c')^2),
/// which is finite where J is not, and does not cancel where Ft is nearly 0.
template <class Real>
Entry<Real> enter(Real cosine, const Interface<Real>& side) {
    const Real eta = side.eta;
    // eta^2 c'^2, exact for eta = 1.
    const Real inside = cosine * cosine + (eta - Real(1)) * (eta + Real(1));
    if (!(cosine > 0) || !(inside > 0)) {
        return {Real(0), Real(1), Real(0)};
    }
    const Real c = std::min(cosine, Real(1));
    const Real refracted = std::min(std::sqrt(inside) / eta, Real(1));
    const Real s = c + eta * refracted, p = eta * c + refracted;
    const Real both = Real(1) / (s * s) + Real(1) / (p * p);
    const Real factor = side.jacobian ? c / eta : eta * refracted;
    return {Real(2) * c * factor * both, c / refracted, refracted};
}

/// Direction of the light inside, pointing away from the interior point, toward the boundary.
/// `w`: toward the light outside, `normal`: outward at the entry; both unit. Snell's law as
/// vectors.
inline glm::dvec3 refracted_direction(glm::dvec3 w, glm::dvec3 normal, double eta) {
    const double cosine = glm::dot(w, normal);
    const double inside =
        std::sqrt(std::max(0.0, cosine * cosine + (eta - 1.0) * (eta + 1.0))) / eta;
    return (w - cosine * normal) / eta + inside * normal;
}

/// e^x for x <= 0, 0 below -80; relative error under 3e-7. Branch-free, so that loops vectorise.
/// Unlike std::exp, the same on every machine.
inline float exp_of_negative(float x) {
    constexpr float kLog2E = 1.44269504f, kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;
    const float clamped = std::max(x, -80.0f);
    const float k = static_cast<float>(static_cast<std::int32_t>(clamped * kLog2E - 0.5f));
    const float r = (clamped - k * kLn2High) - k * kLn2Low;
    // Taylor series to r^7 on |r| <= ln(2) / 2.
    float e = 1.0f / 5040.0f;
    e = e * r + 1.0f / 720.0f;
    e = e * r + 1.0f / 120.0f;
    e = e * r + 1.0f / 24.0f;
    e = e * r + 1.0f / 6.0f;
    e = e * r + 0.5f;
    e = e * r + 1.0f;
    e = e * r + 1.0f;
    const auto exponent = static_cast<std::uint32_t>(static_cast<std::int32_t>(k) + 127) << 23;
    const float power = std::bit_cast<float>(exponent);
    return x < -80.0f ? 0.0f : e * power;
}

}  // namespace opaline::bake
