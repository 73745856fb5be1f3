#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// How the end of a segment moves.
struct TransferChange {
    double dt = 0;     ///< of the length [m]
    glm::dvec3 dP{0};  ///< of the new vertex [m]
};

/// From P to P + t D on a surface with geometric normal N_g, either way round; D need not be unit,
/// D.N_g != 0. Exact on curved surfaces too: only their tangent plane enters.
/// dt = -N_g.w / (N_g.D), dP' = w + dt D, w = dP + t dD; D keeps its dD.
inline TransferChange transfer_to_plane(const glm::dvec3& D, const glm::dvec3& N_g, double t,
                                        const glm::dvec3& dP, const glm::dvec3& dD) {
    const glm::dvec3 w = dP + t * dD;
    const double dt = -glm::dot(N_g, w) / glm::dot(N_g, D);
    return {dt, w + dt * D};
}

/// To a point inside a volume, whose distance moves by dt.
inline glm::dvec3 transfer_in_volume(const glm::dvec3& D, double t, double dt, const glm::dvec3& dP,
                                     const glm::dvec3& dD) {
    return dP + t * dD + dt * D;
}

/// A segment between two vertices that both may move: X to Y = X + r D.
struct Connection {
    glm::dvec3 D{0};  ///< unit
    double r = 0;     ///< [m], > 0

    double length_change(const glm::dvec3& dX, const glm::dvec3& dY) const {
        return glm::dot(D, dY - dX);
    }
    glm::dvec3 direction_change(const glm::dvec3& dX, const glm::dvec3& dY) const {
        return (dY - dX - D * length_change(dX, dY)) / r;
    }
};

inline Connection connect(const glm::dvec3& X, const glm::dvec3& Y) {
    const double r = glm::length(Y - X);
    return {(Y - X) / r, r};
}

}  // namespace opaline::bake
