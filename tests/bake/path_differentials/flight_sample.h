#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// A sampled distance in a medium, and its derivatives.
struct FlightSample {
    double t = 0;           ///< [m]
    double dt_du = 0;       ///< [m]
    double dt_dsigma = 0;   ///< per change of the extinction [m^2]
    double dt_dlength = 0;  ///< per change of the bound
};

/// t = -ln(1 - u) / sigma; sigma > 0 [1/m], u in [0, 1). dt_du grows as 1 / (1 - u).
FlightSample sample_flight_distance(double sigma, double u);

/// Below the bound L > 0 [m]: t = -ln(1 - u Q) / sigma, Q = 1 - e^(-sigma L); sigma >= 0, u in
/// [0, 1]. Below sigma L = 1e-4, where differences of nearly equal terms lose digits, by series.
FlightSample sample_bounded_distance(double sigma, double length, double u);

/// A medium that varies, along a ray to the sampled point: what depends on the extinction alone.
struct VariedFlight {
    double sigma_end = 0;             ///< extinction at the sampled point [1/m], > 0
    glm::dvec3 integral{0};           ///< int_0^t grad sigma ds [1/m]
    glm::dvec3 weighted_integral{0};  ///< int_0^t s grad sigma ds; 0 both: locally constant

    /// dt/du = 1 / (sigma (1 - u)).
    double own_change(double u) const { return 1 / (sigma_end * (1 - u)); }
    /// Of an earlier variable: -(1/sigma) int grad sigma.(dP + s dD) ds.
    double change(const glm::dvec3& dP, const glm::dvec3& dD) const {
        return -(glm::dot(integral, dP) + glm::dot(weighted_integral, dD)) / sigma_end;
    }
};

}  // namespace opaline::bake
