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

}  // namespace opaline::bake
