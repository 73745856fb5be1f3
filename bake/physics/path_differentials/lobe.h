#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// Widths of a GGX distribution of normals along the first two axes of the local frame, in (0, 1].
struct MicrofacetWidths {
    double x = 0.5, y = 0.5;
};

/// A normal m of the microfacets that w_i sees, in the frame whose third axis is the surface's
/// normal, of the density D(m) G1(w_i) (w_i.m) / w_i.z = 1 / |dm_du x dm_dv| by a uniform cap of
/// the sphere [Dupuy2023]; and how m moves. All that follows from m is a mirror or a refraction at
/// N = m, D = -w_i, with dD = -dw_i.
struct VisibleNormal {
    glm::dvec3 m{0, 0, 1};
    glm::dvec3 dm_du{0}, dm_dv{0};
    glm::dmat3 dm_dwi{0.0};  ///< at fixed (u, v)
};

/// w_i: unit, away from the surface, w_i.z > 0. u, v as map_to_disk has them.
VisibleNormal sample_visible_normal(const glm::dvec3& w_i, const MicrofacetWidths& widths, double u,
                                    double v);

/// How a point of the disk moves with one random number.
struct DiskColumn {
    double dq = 0;          ///< change of the squared radius
    double radial = 0;      ///< along `outward`
    double tangential = 0;  ///< along `outward` turned by +90 degrees
};

/// A point of the unit disk and its derivatives.
struct DiskPoint {
    double q = 0, radius = 0;  ///< q = radius^2 in [0, 1]
    glm::dvec2 outward{1, 0};  ///< unit
    DiskColumn du, dv;
};

/// Uniform over the disk's area: squares around the middle become circles, so that no derivative
/// diverges there. u, v in [0, 1]. Columns jump on the diagonals; the area that they span is pi
/// everywhere.
DiskPoint map_to_disk(double u, double v);

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
