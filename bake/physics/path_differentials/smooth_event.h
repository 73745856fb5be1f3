#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace opaline::bake {

/// Mirror reflection of the unit direction of propagation D at the unit normal N.
struct Mirror {
    glm::dvec3 D{0}, N{0};
    double k = 0;             ///< D.N
    glm::dvec3 reflected{0};  ///< D - 2 k N, unit

    /// dR = dD - 2 (k dN + dk N).
    glm::dvec3 change(const glm::dvec3& dD, const glm::dvec3& dN) const {
        return dD - 2.0 * (k * dN + cosine_change(dD, dN) * N);
    }
    /// dk = dD.N + D.dN.
    double cosine_change(const glm::dvec3& dD, const glm::dvec3& dN) const {
        return glm::dot(dD, N) + glm::dot(D, dN);
    }
};

Mirror make_mirror(const glm::dvec3& D, const glm::dvec3& N);

/// Refraction of D at N, D.N < 0; eta = index of this side over index of the other one.
struct Refraction {
    Mirror mirror;  ///< D, N and k, and what is reflected instead
    double eta = 1;
    double c_t = 1;           ///< cosine on the other side, (0, 1]
    glm::dvec3 refracted{0};  ///< eta D - (eta k + c_t) N, unit

    /// d(c_t^2) = 2 eta^2 k dk.
    double square_cosine_change(double dk) const { return 2 * eta * eta * mirror.k * dk; }
    /// dT = eta dD - mu dN - dmu N, dmu = eta dk + d(c_t), for a change of c_t that is given.
    glm::dvec3 change_by(const glm::dvec3& dD, const glm::dvec3& dN, double dc_t) const {
        const double dmu = eta * mirror.cosine_change(dD, dN) + dc_t;
        return eta * dD - (eta * mirror.k + c_t) * dN - dmu * mirror.N;
    }
    /// The derivative itself: d(c_t) = eta^2 k dk / c_t, unbounded towards total reflection.
    glm::dvec3 change(const glm::dvec3& dD, const glm::dvec3& dN) const {
        const double dk = mirror.cosine_change(dD, dN);
        return change_by(dD, dN, square_cosine_change(dk) / (2 * c_t));
    }
};

/// Nothing under total reflection: the event is a mirror then.
std::optional<Refraction> make_refraction(const glm::dvec3& D, const glm::dvec3& N, double eta);

}  // namespace opaline::bake
