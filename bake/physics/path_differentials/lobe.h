#pragma once

#include <glm/glm.hpp>

#include "bake/physics/path_differentials/disk_map.h"

namespace opaline::bake {

/// A density of directions that is symmetric around an axis, as a function of the share q in [0, 1]
/// of its directions that are nearer to the axis.
struct Lobe {
    enum class Kind {
        power,              ///< cos^S; S >= 0: 0 uniform over the hemisphere, 1 cosine, else Phong
        henyey_greenstein,  ///< g in (-1, 1), around the direction of propagation
        cone,               ///< uniform where the cosine exceeds c_max in [-1, 1)
        cap                 ///< uniform on the cap of height K in (0, 2] of the unit sphere
    };
    Kind kind = Kind::power;
    double parameter = 1;  ///< S, g, c_max or K
};

/// A lobe at q.
struct LobePoint {
    double cosine = 1;          ///< between direction and axis
    double square_sine_over_q;  ///< sin^2 / q, finite and without cancellation down to q = 0
    double dcosine = 0;         ///< d cosine / dq = -1 / (2 pi pdf)
    double dln_pdf = 0;         ///< d ln pdf / dq
};

/// q in [0, 1). At q = 1 cosine and sine are right; derivatives need not be finite.
LobePoint eval_lobe(const Lobe& lobe, double q);

/// A direction in a frame whose third axis is the lobe's, and how it moves with u and v.
struct LobeDirection {
    glm::dvec3 D{0, 0, 1};
    glm::dvec3 dD_du{0}, dD_dv{0};
    double dln_pdf_du = 0, dln_pdf_dv = 0;  ///< of the pdf 1 / |dD_du x dD_dv|
};

/// u, v as map_to_disk has them, q < 1. Derivatives are exact: unbounded where the density ends (q
/// near 1). `secant_of_lobe` bounds them.
LobeDirection sample_lobe(const Lobe& lobe, double u, double v);

}  // namespace opaline::bake
