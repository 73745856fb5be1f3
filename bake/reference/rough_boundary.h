#pragma once

#include <glm/glm.hpp>

#include <optional>

#include "bake/base/frame.h"

namespace opaline::bake {

/// Reflection and transmission of a ray at a smooth dielectric boundary.
struct BoundarySplit {
    float reflectance = 0;     ///< unpolarised Fresnel reflectance in [0, 1]; 1: total reflection
    glm::vec3 reflected{0};    ///< unit
    glm::vec3 transmitted{0};  ///< unit; unset under total reflection
};

/// `direction`: unit, of propagation, toward the boundary. `normal`: unit, against the direction:
/// dot(direction, normal) < 0. `ratio`: index of refraction beyond over index on this side, > 0.
BoundarySplit split_at_boundary(glm::vec3 direction, glm::vec3 normal, float ratio);

/// An interpolated normal where it fits the ray. Where it faces away or reflects to behind the
/// triangle, it is turned toward the triangle's own normal until it does not: as little as needed,
/// so that the reflected ray has no jump where that begins. Both normals point away from the same
/// side; the triangle's normal is against the direction.
glm::vec3 fitting_normal(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat);

/// The split at the normal that fits. A ray that it refracts to in front of the triangle is
/// reflected totally: from the denser side such a normal lies close to the critical angle.
BoundarySplit split_at_smooth_boundary(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat,
                                       float ratio);

/// A dielectric boundary of GGX microfacets [Walter2007], as one direction (the eye, or back along
/// the path) sees it. Facets reflect or refract once; light that would meet a second one is lost:
/// at alpha 0.04 up to 0.2 % of even light along the normal. Radiance is per squared index.
struct RoughBoundary {
    Frame frame;           ///< about the normal, on the eye's side
    glm::dvec3 to_eye{0};  ///< unit, local; at least kGrazingCosine above the horizon
    double alpha = 1;      ///< GGX width
    double ratio = 1;      ///< index of refraction beyond over that on the eye's side, > 0, not 1
    /// What is sampled: reflection, transmission, or either by each facet's Fresnel reflectance.
    bool reflects = true, transmits = true;
};

/// `normal` and `to_eye` are unit, in world space. An eye below the horizon counts as grazing.
RoughBoundary make_rough_boundary(glm::vec3 normal, glm::vec3 to_eye, float alpha, float ratio);

struct BoundarySample {
    glm::vec3 direction{0};  ///< unit, world space
    bool transmits = false;  ///< else it is on the eye's side
    float weight = 0;        ///< response / pdf, at most 1
    float pdf = 0;           ///< [1/sr]
};

/// By visible normals. u, v, choice in [0, 1). Nothing where the direction is on the wrong side of
/// the surface, or a facet does what is not sampled.
std::optional<BoundarySample> sample_rough_boundary(const RoughBoundary& boundary, float u, float v,
                                                    float choice);

/// Toward a direction on either side: f cosine, per squared index, and the density of
/// `sample_rough_boundary`, both [1/sr]. f(o, l) / n_l^2 = f(l, o) / n_o^2. 0 on a side that is not
/// sampled.
struct BoundaryValue {
    float response = 0, pdf = 0;
};
BoundaryValue eval_rough_boundary(const RoughBoundary& boundary, glm::vec3 to_light);

}  // namespace opaline::bake
