#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// A texel of a cube face as inversion of cumulative sums finds it: u falls into the step of the
/// texel's column, v into that of its row within the column.
struct TexelChoice {
    glm::dvec3 axis{0, 0, 1}, S{1, 0, 0}, T{0, 1, 0};  ///< of the face: h = axis + s S + t T
    double s = 0, t = 0, width = 0;                    ///< lower corner of the texel, and its size
    double column_start = 0, column_mass = 1;          ///< u in [start, start + mass]
    double row_start = 0, row_mass = 1;
};

/// A direction to a distant light, and how it moves with u and v.
struct EnvironmentSample {
    glm::dvec3 D{0};
    glm::dvec2 st{0};
    glm::dvec3 dD_du{0}, dD_dv{0};
    double pdf = 0;  ///< over solid angle [1/sr]
};

/// 1 / pdf = width^2 / (column_mass row_mass (1 + s^2 + t^2)^(3/2)): bright texels move little.
EnvironmentSample sample_texel(const TexelChoice& texel, double u, double v);

}  // namespace opaline::bake
