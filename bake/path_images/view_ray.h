#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/path_images/band.h"

namespace opaline::bake {

/// A step along a view ray in one band, at its middle.
struct ViewStep {
    double scattered = 0;   ///< int b e^-tau ds over the step: what scatters here and is seen
    double depth = 0;       ///< b ds
    double ell = 0;         ///< int b ds from the eye
    double absorption = 0;  ///< int a ds
    double tau = 0;         ///< int c ds
};

/// The steps of a ray through all volumes, and its depths to where it ends.
struct ViewBand {
    std::vector<ViewStep> step;
    double ell = 0, tau = 0;
};
struct ViewRay {
    glm::vec3 origin{0}, direction{0, 0, 1};  ///< unit
    float entry = 0, reach = 0;               ///< [m] where density begins; where the ray ends
    std::vector<glm::vec3> position;          ///< [m] of the steps
    std::vector<ViewBand> band;

    bool is_empty() const { return position.empty(); }
};

/// Steps of at most a voxel and about a quarter of optical depth; within a step coefficients are
/// constant, and `scattered` is exact.
ViewRay march_view_ray(const VolumeSpace& space, std::span<const MediumBand> bands,
                       glm::vec3 origin, glm::vec3 direction, float reach);

}  // namespace opaline::bake
