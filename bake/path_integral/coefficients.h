#pragma once

namespace opaline::bake {

/// What a medium does to light at one point, for one band. The functions of this room take a medium
/// as any callable `Coefficients medium(glm::dvec3 position)`, finite everywhere.
struct Coefficients {
    double scattering = 0;  ///< b [1/m], >= 0
    double absorption = 0;  ///< a [1/m], >= 0

    double extinction() const { return scattering + absorption; }  ///< c [1/m]
};

}  // namespace opaline::bake
