#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "bake/physics/path_differentials/lobe.h"

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
