#pragma once

#include <glm/glm.hpp>

#include "bake/effects/multiple/walks/walk.h"
#include "bake/lights/true_irradiance.h"

namespace opaline::bake {

/// Moments of the direction w_e of an exit: of one direction, or of the mean over all walks with
/// the same way and number of scatterings.
struct ExitDirection {
    glm::vec3 mean{0};    ///< of w_e
    glm::mat3 square{0};  ///< mean of w_e w_e^T
};

/// Directions of light that crosses a boundary (README.md, "The light at an exit"). With c the
/// cosine to the outward normal and <> the mean under p = F_t c / (pi c_exit):
struct ExitLobe {
    double mean = 0;            ///< <c>
    double square = 1;          ///< <c^2>
    double tilt = 0;            ///< <c (1 - c^2)> / <1 - c^2>
    double diffuse = 0;         ///< mean of c over exits of light that was scattered often
    double diffuse_square = 0;  ///< mean of c^2 over them
    double eta = 1;             ///< of the boundary
    /// Of the functions of degree two of `eval`: b = P_2(c) - level - slope (c - <c>).
    double level = 0, slope = 0;
    double bend = 1;    ///< <b^2>
    double tilted = 1;  ///< <(c - tilt)^2 (1 - c^2)>
    double around = 1;  ///< <(1 - c^2)^2>

    /// Of an exit near a surface whose normal is `normal`, unit; where it leaves below that
    /// surface's horizon it is of another facet, and any direction is as likely as diffuse light
    /// has it.
    ExitDirection direction(glm::vec3 normal, const WalkExit& exit) const;

    /// Light from w times this is what an exit along `exit`, unit, away from the body, sees: the
    /// reproducing kernel of degree two. Its mean over p is 1, and it is exact for unoccluded light
    /// that is quadratic in w. Even where `exit` is below the horizon of `normal`.
    LightFactor eval(glm::vec3 normal, glm::vec3 exit) const;
};

/// `eta` > 0.
ExitLobe make_exit_lobe(double eta);

/// z, in transport mean free paths: inside a boundary of that index light that was scattered often
/// has a radiance of z + c' in proportion, c' the cosine toward the boundary.
double extrapolation_length(double eta);

}  // namespace opaline::bake
